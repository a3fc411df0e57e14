// The poles of the closed loop in the complex plane: a cross for each pole across the path, a plus for each along it.

import { made } from "../core/dom"
import { letters, Sheet, stroke, tones, type Pixel, type Tone } from "../core/ink"
import { niceStep } from "../core/numbers"
import { phrase, significant, type Texts } from "../core/words"

export interface Pole {
    along: boolean
    real: number // [1/s]
    imaginary: number
}

const RIGHT = 0.2 // share of the width to the right of the imaginary axis
const MARGIN = 14 // [px] around the plane
const LEAST = 5 // [1/s], smallest range of the real axis
const MARKED = 60 // [px], least distance of marks on the axis
const SIZE = 5 // [px], half the size of a cross or plus
const FONT = "12px system-ui, sans-serif"
const BOLD = "700 15px system-ui, sans-serif"
const PLUS: Pixel[][] = [[[-SIZE - 1, 0], [SIZE + 1, 0]], [[0, -SIZE - 1], [0, SIZE + 1]]]
const CROSS: Pixel[][] = [[[-SIZE, -SIZE], [SIZE, SIZE]], [[-SIZE, SIZE], [SIZE, -SIZE]]]

/** The poles in a field's value. */
export function polesIn(text: string): Pole[] {
    return text.split("\n").filter(Boolean).map(line => {
        const [channel, real, imaginary] = line.split(" ")
        return { along: channel === "along", real: Number(real), imaginary: Number(imaginary) }
    })
}

/** Where 0 is, [px], and pixels per 1/s: the same to the right and upwards, so that lines through 0 are those of equal
 * damping. All poles are seen except for those far to the right. */
export function planeOf(poles: readonly Pole[], width: number, height: number): { zero: Pixel; scale: number } {
    const zero: Pixel = [width * (1 - RIGHT), height / 2]
    const left = Math.max(LEAST, ...poles.map(({ real }) => -real))
    const up = Math.max(1e-9, ...poles.map(({ imaginary }) => Math.abs(imaginary)))
    return { zero, scale: Math.min((zero[0] - MARGIN) / left, (height / 2 - MARGIN) / up) }
}

export class PolePlane {
    readonly sheet = new Sheet(() => this.draw(), true)
    readonly element: HTMLElement
    private poles: Pole[] = []
    private shown = ""

    constructor(private readonly texts: Texts) {
        this.sheet.canvas.setAttribute("role", "img")
        this.element = made("div", "poles", this.sheet.canvas)
    }

    show(value: string): void {
        if (value === this.shown) return
        this.shown = value
        this.poles = polesIn(value)
        this.draw()
    }

    private draw(): void {
        const { sheet, poles, texts } = this, { width, height } = sheet
        const ink = sheet.cleared()
        if (!ink) return
        const { zero: [x, y], scale } = planeOf(poles, width, height)
        const { ink: dark, soft, paper, warning } = tones()
        ink.globalAlpha = 0.12
        ink.fillStyle = warning
        ink.fillRect(x, 0, width - x, height)
        ink.globalAlpha = 1
        stroke(ink, [[0, y], [width, y]], soft, 1)
        stroke(ink, [[x, 0], [x, height]], soft, 1)
        ink.font = FONT
        ink.textBaseline = "middle"
        const write = (text: string, at: Pixel, align: CanvasTextAlign) => {
            ink.textAlign = align
            letters(ink, text, ...at, dark, paper)
        }
        const step = niceStep(MARKED / scale)
        for (let value = step; scale * value < x - MARGIN; value += step) {
            stroke(ink, [[x - scale * value, y - 3], [x - scale * value, y + 3]], soft, 1)
            write(significant(texts, -value, 3), [x - scale * value, y + 13], "center")
        }
        write(phrase(texts, "gains.rate"), [4, height - 8], "left")
        write(phrase(texts, "gains.swing"), [x - 4, 8], "right")
        this.legend(ink)
        for (const { along, real, imaginary } of poles) {
            const at: Pixel = [x + scale * real, y - scale * imaginary]
            if (at[0] > width) continue
            for (const line of along ? PLUS : CROSS) stroke(ink, line.map(([dx, dy]): Pixel => [at[0] + dx, at[1] + dy]), tones()[toneOf(along)], 2.5)
        }
    }

    /** Which mark is whose. */
    private legend(ink: CanvasRenderingContext2D): void {
        const { texts } = this, { ink: dark } = tones()
        ink.textAlign = "left"
        let x = 4
        for (const [along, sign, key] of [[false, "×", "gains.across"], [true, "+", "gains.along"]] as const)
            for (const [text, font, fillStyle] of [[sign, BOLD, tones()[toneOf(along)]], [phrase(texts, key), FONT, dark]] as const) {
                Object.assign(ink, { font, fillStyle })
                ink.fillText(text, x, 8)
                x += ink.measureText(text).width + (text === sign ? 4 : 10)
            }
    }
}

function toneOf(along: boolean): Tone {
    return along ? "ink" : "force"
}
