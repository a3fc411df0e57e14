// What is drawn besides a robot: the same as in the scene of the lab; see app/exports/standalone/drawings.py.

import type { DrawingsData, PlaneImage, Point } from "../core/figure_data"
import { arrow, letters, stroke, tones, type Pixel } from "../core/ink"
import type { Path } from "../simulation/path"
import type { Side } from "../simulation/side"

const POINTS_OF_ELLIPSE = 49
const [FILL, LETTERS] = [0.22, "600 0.95rem system-ui, sans-serif"]
const BEHIND = 0.014 // [m] from the tail of an arrow to its text

/** What is drawn of a robot. */
export interface Scene {
    side: Side
    /** The robot whose point runs by the clock. */
    clock: Side
    path: Path
    /** The place of the path among those of the figure. */
    number: number
    pixel: (point: Point) => Pixel
    /** Pixels for a metre. */
    scale: number
}

export class Drawings {
    /** Names of what is shown. */
    shown: ReadonlySet<string>
    private readonly images = new Map<PlaneImage, HTMLImageElement>()
    private tube: { path: Path; edges: Point[][]; across: Point[][]; along: Point[][] } | null = null

    constructor(private readonly data: DrawingsData, private readonly changed: () => void) {
        this.shown = new Set(data.shown)
    }

    /** Draw what is beneath a robot and its path. */
    beneath(ink: CanvasRenderingContext2D, scene: Scene): void {
        const { data: { rank, zone }, shown } = this
        if (zone) this.image(ink, zone, scene)
        if (rank && shown.has("rank")) this.image(ink, rank, scene)
        if ((shown.has("tube") || shown.has("grid")) && !scene.path.edited) this.around(ink, scene)
    }

    /** Draw what is over them. */
    over(ink: CanvasRenderingContext2D, scene: Scene): void {
        const { shown, data } = this, colours = tones(), { side, pixel } = scene
        if (shown.has("mass")) stroke(ink, side.drawn("ellipse", POINTS_OF_ELLIPSE).map(pixel), colours.mass, 2.5)
        if (shown.has("errors")) {
            const tip = pixel(side.tip())
            arrow(ink, tip, pixel(scene.clock.reference()), colours.side0, 3)
            arrow(ink, tip, pixel(side.closest()), colours.side1, 3)
        }
        if (shown.has("labels") && data.labels) this.labels(ink, data.labels, scene)
        for (const mark of data.marks) this.mark(ink, mark, scene)
    }

    private labels(ink: CanvasRenderingContext2D, { names, points, axes, axisNames }: NonNullable<DrawingsData["labels"]>, scene: Scene): void {
        const { pixel, side } = scene, colours = tones()
        for (const [from, to] of axes) arrow(ink, pixel(from), pixel(to), colours.ink, 1.5)
        const drawn = side.drawn("labels", points)
        for (let i = names.length; i + 1 < points; i += 2) stroke(ink, [pixel(drawn[i]!), pixel(drawn[i + 1]!)], colours.arc, 1.5)
        for (const { text, place } of axisNames) write(ink, text, pixel(place))
        names.forEach((name, i) => write(ink, name, pixel(drawn[i]!)))
    }

    private mark(ink: CanvasRenderingContext2D, { at, from, text }: DrawingsData["marks"][number], { pixel }: Scene): void {
        const far = from ? Math.hypot(at[0] - from[0], at[1] - from[1]) : 1
        const place: Point = from ? [from[0] + (BEHIND * (from[0] - at[0])) / far, from[1] + (BEHIND * (from[1] - at[1])) / far] : at
        if (from) arrow(ink, pixel(from), pixel(at), tones().ink, 2)
        if (text) write(ink, text, pixel(place))
    }

    /** The tube, and the lines of the same θ and of the same ξ. */
    private around(ink: CanvasRenderingContext2D, { path, number, pixel }: Scene): void {
        const { edges, across, along } = this.lines(path, number), { shown } = this, colours = tones()
        if (shown.has("tube")) {
            ink.globalAlpha = FILL
            ink.fillStyle = colours.selected
            ink.beginPath()
            for (const [x, y] of [...edges[0]!, ...[...edges[1]!].reverse()].map(pixel)) ink.lineTo(x, y)
            ink.fill("evenodd")
            ink.globalAlpha = 1
        }
        if (shown.has("grid")) for (const line of [...across, ...along]) stroke(ink, line.map(pixel), colours.steel, 0.8)
    }

    private lines(path: Path, number: number): NonNullable<Drawings["tube"]> {
        if (this.tube?.path === path) return this.tube
        const { shown, across, along, lines } = this.data.tubes![number]!
        const theta = (i: number) => (2 * i / along - 1) * Math.PI
        const curve = (xi: number) => Array.from({ length: along + 1 }, (_, i) => path.beside(theta(i), xi))
        const spokes = Array.from({ length: lines + 1 }, (_, i) => {
            const at = theta((i * along) / lines)
            return [path.beside(at, -shown), path.beside(at, shown)]
        })
        return (this.tube = {
            path, edges: [curve(-shown), curve(shown)], across: spokes, along: across.flatMap(xi => [curve(-xi), curve(xi)]),
        })
    }

    private image(ink: CanvasRenderingContext2D, image: PlaneImage, { pixel }: Scene): void {
        const picture = this.loaded(image)
        if (!picture.complete || !picture.naturalWidth) return
        const { corner, right, up } = image
        const [x, y] = pixel([corner[0] + up[0], corner[1] + up[1]])
        const [toX, toY] = pixel([corner[0] + up[0] + right[0], corner[1] + up[1] + right[1]])
        const [downX, downY] = pixel(corner)
        const { naturalWidth: width, naturalHeight: height } = picture
        ink.save()
        ink.transform((toX - x) / width, (toY - y) / width, (downX - x) / height, (downY - y) / height, x, y)
        ink.drawImage(picture, 0, 0)
        ink.restore()
    }

    private loaded(image: PlaneImage): HTMLImageElement {
        const known = this.images.get(image)
        if (known) return known
        const picture = new Image()
        picture.addEventListener("load", this.changed)
        picture.src = image.src
        this.images.set(image, picture)
        return picture
    }
}

function write(ink: CanvasRenderingContext2D, text: string, [x, y]: Pixel): void {
    ink.font = LETTERS
    ink.textAlign = "center"
    ink.textBaseline = "middle"
    letters(ink, text, x, y, tones().ink, tones().paper)
}
