// The parameters of the loops that may change: their values, and what they set.

import type { ChangesData, LoopsData, Setting } from "../core/figure_data"

export class Changes {
    values: Record<string, Setting>

    constructor(private readonly data: ChangesData, private readonly loops: LoopsData) {
        this.values = { ...data.values }
    }

    /** The first values, as when the page was opened. */
    begin(): void {
        this.values = { ...this.data.values }
    }

    /** Places in the settings of the loops, and the numbers that belong there. */
    *numbers(): Iterable<[number, number]> {
        const { values } = this
        for (const [name, index] of Object.entries(this.data.indices)) yield [index, Number(values[name])]
        for (const table of this.data.tables) {
            const row = nearest(table.values, table.names.map(name => values[name]!))
            for (const [i, index] of table.indices.entries()) yield [index, table.numbers[row]![i]!]
        }
    }

    /** The number of the variant of the loops. */
    get variant(): number {
        const classes = Object.entries(this.loops.classes).map(([name, options]) => {
            const value = this.values[name]!
            return options.length ? options.indexOf(value) : Number(value !== 0)
        })
        return this.loops.keys[classes.join(",")] ?? 0
    }
}

/** The row with these values, or the nearest numbers. */
function nearest(rows: readonly Setting[][], wanted: readonly Setting[]): number {
    const far = (row: readonly Setting[]) => row.reduce<number>((sum, value, i) => sum + away(value, wanted[i]!), 0)
    return rows.reduce((best, row, i) => (far(row) < far(rows[best]!) ? i : best), 0)
}

function away(a: Setting, b: Setting): number {
    return typeof a === "number" && typeof b === "number" ? Math.abs(a - b) : a === b ? 0 : Infinity
}
