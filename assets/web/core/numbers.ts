// Numbers as Python and NumPy format and sum them, so that checks give the same texts as in the lab.

/** A sum in NumPy's order: pairwise. */
export function sum(values: ArrayLike<number>, from = 0, count = values.length): number {
    if (count < 8) {
        let total = 0
        for (let i = from; i < from + count; i++) total += values[i]!
        return total
    }
    if (count <= 128) {
        const parts = Array.from({ length: 8 }, (_, i) => values[from + i]!)
        let i = 8
        for (; i < count - (count % 8); i += 8)
            for (let j = 0; j < 8; j++) parts[j]! += values[from + i + j]!
        const [a, b, c, d, e, f, g, h] = parts as [number, number, number, number, number, number, number, number]
        let total = a + b + (c + d) + (e + f + (g + h))
        for (; i < count; i++) total += values[from + i]!
        return total
    }
    const half = Math.floor(count / 2) - (Math.floor(count / 2) % 8)
    return sum(values, from, half) + sum(values, from + half, count - half)
}

/** The leading digits of a number, and its exponent; ties go to the even digit, as in Python. */
function rounded(value: number, digits: number): [string, number] {
    const [mantissa, exponent] = value.toExponential(60).split("e") as [string, string]
    const all = mantissa.replace(".", "")
    const rest = all.slice(digits)
    const last = Number(all[digits - 1])
    const up = rest[0]! > "5" || (rest[0] === "5" && (/[1-9]/.test(rest.slice(1)) || last % 2 === 1))
    const kept = (BigInt(all.slice(0, digits)) + (up ? 1n : 0n)).toString()
    return kept.length > digits ? [kept.slice(0, digits), Number(exponent) + 1] : [kept, Number(exponent)]
}

/** `f"{value:.{digits}g}"`. */
export function general(value: number, digits: number): string {
    if (value === 0) return Object.is(value, -0) ? "-0" : "0"
    const sign = value < 0 ? "-" : ""
    const [kept, exponent] = rounded(Math.abs(value), digits)
    const bare = (text: string) => (text.includes(".") ? text.replace(/\.?0*$/, "") : text)
    if (exponent < -4 || exponent >= digits) {
        const size = String(Math.abs(exponent)).padStart(2, "0")
        return `${sign}${bare(`${kept[0]}.${kept.slice(1)}`)}e${exponent < 0 ? "-" : "+"}${size}`
    }
    if (exponent < 0) return sign + bare(`0.${"0".repeat(-exponent - 1)}${kept}`)
    return sign + bare(`${kept.slice(0, exponent + 1)}.${kept.slice(exponent + 1)}`)
}

/** `f"{value:.{digits}f}"` for a number below 1 in size, without a minus sign at zero. */
export function fixed(value: number, digits: number): string {
    const size = Math.abs(value)
    const exponent = size === 0 ? -400 : Number(size.toExponential(60).split("e")[1])
    const wanted = exponent + 1 + digits // digits that are kept
    let whole = "0"
    if (wanted > 0) {
        const [kept, moved] = rounded(size, wanted)
        whole = kept + "0".repeat(Math.max(0, moved + digits + 1 - kept.length))
    } else if (wanted === 0 && size > 0.5 * 10 ** -digits) whole = "1"
    const text = whole.padStart(digits + 1, "0")
    const shown = `${text.slice(0, -digits)}.${text.slice(-digits)}`
    return value < 0 && /[1-9]/.test(shown) ? `-${shown}` : shown
}

/** The step of a scale, 1, 2 or 5 times a power of ten, that is at least as large as asked. */
export function niceStep(least: number): number {
    const ten = 10 ** Math.floor(Math.log10(least))
    return [1, 2, 5, 10].map(each => each * ten).find(each => each >= least * (1 - 1e-9)) ?? 10 * ten
}
