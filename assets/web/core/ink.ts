// Drawing on canvases, in pixels of the page, without asking the browser for the layout.

export type Pixel = readonly [number, number]

/** The colours of the page's style, light or dark; see assets/templates/web/parts.css. */
const NAMES = [
    "paper", "ink", "soft", "grid", "path", "point", "selected", "warning", "steel", "force", "held", "pulled", "yours", "mass", "arc",
    "side0", "side1", "dark0", "dark1",
] as const
export type Tone = (typeof NAMES)[number]
type Tones = Record<Tone, string>

const LIGHTER = 0.6 // opacity of a link between strokes
const sheets = new WeakMap<HTMLCanvasElement, Sheet>()
let kept: Tones | null = null
let larger = 1

export function tones(): Tones {
    if (kept) return kept
    const style = getComputedStyle(document.documentElement)
    kept = Object.fromEntries(NAMES.map(name => [name, style.getPropertyValue(`--tone-${name}`).trim()])) as Tones
    return kept
}

/** Read the colours again, and draw everything again; for a page that changes its scheme by itself. */
export function retone(): void {
    kept = null
    for (const canvas of document.querySelectorAll("canvas")) sheets.get(canvas)?.changed()
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", retone)

/** Draw whatever has letters so many times as large. */
export function enlarge(times: number): void {
    if (times === larger) return
    larger = times
    for (const canvas of document.querySelectorAll("canvas")) sheets.get(canvas)?.measure()
}

/** A canvas that knows its size. */
export class Sheet {
    readonly canvas = document.createElement("canvas")
    width = 0
    height = 0
    private box = { width: 0, height: 0 }
    // The browser then draws in memory: without a graphics card, the other points costs ten times as much.
    private readonly ink = this.canvas.getContext("2d", { willReadFrequently: true })

    /** `changed`: everything is to be redrawn; `grows`: for a projector it is drawn larger, see `enlarge`. */
    constructor(readonly changed: () => void, private readonly grows = false) {
        const observer = new ResizeObserver(entries => {
            this.box = entries[entries.length - 1]!.contentRect
            this.measure()
        })
        observer.observe(this.canvas)
        sheets.set(this.canvas, this)
    }

    /** How much larger everything is drawn; `width` and `height` are what there is room for. */
    get zoom(): number { return this.grows ? larger : 1 }

    /** Find out how much room there is. */
    measure(): void {
        this.width = this.box.width / this.zoom
        this.height = this.box.height / this.zoom
        this.changed()
    }

    /** The empty canvas; null if it cannot be seen. */
    cleared(): CanvasRenderingContext2D | null {
        const { canvas, ink, width, height } = this
        if (!ink || !width || !height) return null
        const ratio = (window.devicePixelRatio || 1) * this.zoom
        const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)]
        if (canvas.width !== across || canvas.height !== down) Object.assign(canvas, { width: across, height: down })
        ink.setTransform(ratio, 0, 0, ratio, 0, 0)
        ink.clearRect(0, 0, width, height)
        ink.lineCap = ink.lineJoin = "round"
        return ink
    }
}

/** A line through points; it is open where a number is not known. */
export function stroke(ink: CanvasRenderingContext2D, points: readonly Pixel[], colour: string, width: number): void {
    ink.strokeStyle = colour
    ink.lineWidth = width
    ink.beginPath()
    let before = NaN
    for (const [x, y] of points) {
        if (Number.isNaN(before)) ink.moveTo(x, y)
        else ink.lineTo(x, y) // does nothing at NaN
        before = y
    }
    ink.stroke()
}

/** A link between strokes of a drawing, along which the pen is up. */
export function dashed(ink: CanvasRenderingContext2D, points: readonly Pixel[], colour: string, width: number): void {
    const { globalAlpha } = ink
    ink.globalAlpha = LIGHTER * globalAlpha
    ink.setLineDash([2 * width, 3 * width])
    stroke(ink, points, colour, width)
    ink.setLineDash([])
    ink.globalAlpha = globalAlpha
}

export function disc(ink: CanvasRenderingContext2D, [x, y]: Pixel, radius: number, colour: string): void {
    ink.fillStyle = colour
    ink.beginPath()
    ink.arc(x, y, radius, 0, 2 * Math.PI)
    ink.fill()
}

/** An arrow; a short one has a small head. */
export function arrow(ink: CanvasRenderingContext2D, from: Pixel, to: Pixel, colour: string, width: number): void {
    const [dx, dy] = [to[0] - from[0], to[1] - from[1]]
    const length = Math.hypot(dx, dy)
    if (length < 1) return
    const head = Math.min(3.5 * width + 2, 0.6 * length)
    const [x, y] = [(dx / length) * head, (dy / length) * head]
    stroke(ink, [from, [to[0] - x, to[1] - y]], colour, width)
    ink.fillStyle = colour
    ink.beginPath()
    for (const side of [1, -1]) ink.lineTo(to[0] - x - 0.45 * side * y, to[1] - y + 0.45 * side * x)
    ink.lineTo(...to)
    ink.fill()
}

export interface Box {
    left: number
    right: number
    top: number
    bottom: number
}

export function covers(a: Box, b: Box): boolean {
    return a.left < b.right && a.right > b.left && a.top < b.bottom && a.bottom > b.top
}

/** Letters with a rim, so that they can be read on lines. */
export function letters(ink: CanvasRenderingContext2D, text: string, x: number, y: number, colour: string, rim: string): void {
    ink.strokeStyle = rim
    ink.lineWidth = 4
    ink.strokeText(text, x, y)
    ink.fillStyle = colour
    ink.fillText(text, x, y)
}
