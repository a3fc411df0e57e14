// What Python puts into the page: see app/exports/standalone/figure_data.py.

/** Place of the first number in a flat vector, and how many there are. */
export type Place = [number, number]

export interface BenchData {
    title: string
    text: string
    colour: string
    dark: string
    pale: string
    aim: "theta" | "theta_ref"
    byClock: boolean
}

export interface PathData {
    label: string
    kind: string
    table: number[]
    grid: number[]
    outline: number[]
    states: number[][]
    settings: number[][]
}

export interface SliderData {
    label: string
    unit: string
    help: string
    low: number
    high: number
    step: number
    value: number
    place: number
}

export interface FigureData {
    language: string
    title: string
    words: Record<string, string>
    dt: number
    sizes: Record<"p" | "n" | "log" | "bars" | "joints", number>
    state: Record<"q" | "theta", Place>
    settings: Record<
        "hold_active" | "hold_anchor" | "hold_tangent" | "hold_normal" | "hand_active" | "hand_target",
        Place
    >
    log: Record<"q" | "v" | "y" | "theta" | "theta_ref" | "force", Place>
    benches: BenchData[]
    paths: PathData[]
    sliders: SliderData[]
    controls: string[]
    box: [number, number, number, number]
    off: number
    strip: number
    colours: Record<"path" | "force" | "steel" | "ink", string>
    module: string
}

/** A text, with its values filled in. */
export function said(data: FigureData, key: string, values: Record<string, string> = {}): string {
    const text = data.words[key]
    if (text === undefined) throw new Error(`no words for ${key}`)
    return text.replace(/\{(\w+)\}/g, (whole, name: string) => values[name] ?? whole)
}

/** A number as the language writes it. */
export function written(data: FigureData, value: number, digits: number): string {
    return value.toFixed(digits).replace("-", "−").replace(".", data.words["point"] ?? ".")
}
