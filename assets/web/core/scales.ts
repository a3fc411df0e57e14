// The scale of a slider, and numbers as people type them.

const KNEE = { share: 0.02, steps: 10 } // share of the largest number, and steps: below the smaller, a logarithmic scale through zero is nearly linear
const FINE = 0.01 // step on a logarithmic scale, as a share of the number
const NEAR = 0.012 // share of a slider's length within which it snaps to a meaningful number

export class Scale {
    readonly low: number
    readonly high: number
    readonly isLog: boolean
    private readonly step: number
    private readonly knee: number

    constructor({ low, high, step, scale = "linear" }: { low: number; high: number; step: number; scale?: "linear" | "log" }) {
        this.step = step
        // The outermost multiples of the step: a slider from -π stops at 0, too.
        this.low = tidy(Math.ceil(low / step - 1e-9) * step)
        this.high = tidy(Math.floor(high / step + 1e-9) * step)
        this.isLog = scale === "log"
        this.knee = low > 0 ? 0 : Math.min(KNEE.share * Math.max(-low, high), KNEE.steps * step)
    }

    /** Where a number is on the slider, from 0 to 1. */
    place(value: number): number {
        const [low, high, at] = [this.low, this.high, this.clamped(value)].map(each => this.bent(each)) as [number, number, number]
        return high > low ? (at - low) / (high - low) : 0
    }

    /** The number at a place of the slider: a multiple of a step. */
    at(place: number): number {
        if (place <= 0 || place >= 1) return place <= 0 ? this.low : this.high
        const [low, high] = [this.bent(this.low), this.bent(this.high)]
        return this.rounded(this.straight(low + place * (high - low)))
    }

    /** The nearest multiple of the step at this number. */
    rounded(value: number): number {
        const step = this.stepAt(value)
        return this.clamped(tidy(Math.round(value / step) * step))
    }

    /** The number that is some steps further. */
    moved(value: number, steps: number): number {
        const step = this.stepAt(value), exact = value / step
        const from = steps > 0 ? Math.floor(exact + 1e-6) : Math.ceil(exact - 1e-6)
        return this.clamped(tidy((from + steps) * step))
    }

    /** The number, or a meaningful one so near that the hand means it. */
    settled(value: number, meant: readonly number[]): number {
        const place = this.place(value)
        return meant.find(each => Math.abs(this.place(each) - place) < NEAR) ?? value
    }

    readonly clamped = (value: number): number => Math.min(Math.max(value, this.low), this.high)

    /** A number as it is shown: to a tenth of a step. */
    shown(value: number): number {
        const digits = Math.max(0, 1 - Math.floor(Math.log10(this.step) + 1e-9))
        return Number(value.toFixed(Math.min(digits, 12))) + 0 // no -0
    }

    private stepAt(value: number): number {
        if (!this.isLog) return this.step
        const least = FINE * Math.abs(value)
        if (least <= this.step) return this.step
        const size = 10 ** Math.floor(Math.log10(least))
        const nice = [1, 2, 5, 10].find(each => each * size >= least * (1 - 1e-9))! * size
        return this.step * Math.ceil(nice / this.step - 1e-9)
    }

    private bent(value: number): number {
        if (!this.isLog) return value
        return this.knee ? Math.asinh(value / this.knee) : Math.log(value)
    }

    private straight(value: number): number {
        if (!this.isLog) return value
        return this.knee ? this.knee * Math.sinh(value) : Math.exp(value)
    }
}

/** Without what floating-point arithmetic adds behind the last digit. */
function tidy(value: number): number {
    return Number(value.toPrecision(12)) + 0
}

/** The number in a text, with a point or a comma before the decimals, or null. `point`: that of the page's language; only
 * where it is a point do commas divide thousands. */
export function typedNumber(text: string, point: string): number | null {
    let plain = text.replaceAll(/\s/g, "").replaceAll(/[\u2212\u2013]/g, "-") // as typesetters and phones write a minus
    if (point === "." && /^[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?$/.test(plain)) plain = plain.replaceAll(",", "")
    plain = plain.replace(",", ".")
    if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain)) return null
    const number = Number(plain)
    return Number.isFinite(number) ? number + 0 : null
}
