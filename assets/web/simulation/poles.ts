// What the page says about the poles of the laws, as in app/view/poles.py.

import type { FigureData } from "../core/figure_data"
import { said, significant, written } from "../core/words"
import type { Kernels } from "./kernels"

/** The motion across the path, or along it: what is said of it, and a line for each pole, as in app/view/poles.py. */
export interface Channel {
    line: string
    points: string[]
}

const SETTLES = 3 // behaviours before those of a motion that does not

export class Poles {
    private readonly sizes = this.data.poles
    private readonly polynomials = [0, 1].map(() => this.kernels.room(this.sizes.size / 2 + 2))
    private readonly first = this.kernels.room(2 * this.sizes.size)
    private readonly roots = this.first + this.sizes.size
    private readonly result = this.kernels.room(2 * this.sizes.slow + 5)

    constructor(private readonly data: FigureData, private readonly kernels: Kernels) {}

    of(settings: number): Channel[] {
        const { kernels, first, roots, result, sizes } = this
        kernels.call("polynomials", settings, ...this.polynomials, first)
        return this.polynomials.map((polynomial, i) => {
            kernels.copy(first, roots, sizes.size)
            kernels.loop("roots", [roots, polynomial, roots, roots], sizes.steps)
            kernels.numbers[result] = sizes.interval
            kernels.call("settling", roots, polynomial, result, result + 1)
            return this.channel(i ? "along" : "across")
        })
    }

    private channel(name: "across" | "along"): Channel {
        const { data, result } = this
        const { slow, behaviours } = this.sizes
        const found = [...this.kernels.numbers.subarray(result + 1, result + 2 * slow + 5)]
        const [code, time, damping] = found.slice(2 * slow + 1) as [number, number, number]
        const values = { damping: written(data, damping, 2), seconds: significant(data, time, 2) }
        const kind = said(data, `behaviour.${behaviours[code]}`, values)
        const says = code < SETTLES ? said(data, "behaviour.settles", { ...values, kind }) : kind
        const all = Array.from({ length: found[0]! }, (_, i) => [found[2 * i + 1]!, found[2 * i + 2]!] as const)
            .reverse() // the slowest last, as in the lab
        const poles = all.filter(([, imaginary]) => imaginary >= 0)
            .map(([real, y]) => significant(data, real, 3) + (y ? ` ± ${significant(data, y, 3)}i` : ""))
        return {
            line: `${code < SETTLES ? "" : "⚠ "}${said(data, `gains.${name}`)}: ${says}; ${said(data, "gains.poles", { poles: poles.join(", ") })}`,
            points: all.map(pole => `${name} ${pole.join(" ")}`),
        }
    }
}
