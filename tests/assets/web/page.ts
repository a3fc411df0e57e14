// A page for tests in Node: a document without layout, canvases that note what is written on them, and texts that are their
// keys. Import it before what is tested.

import { Window } from "happy-dom"

export const window = new Window({ url: "http://localhost/", width: 1280, height: 800 })
const OVER = new Set(["Event", "EventTarget", "CustomEvent", "navigator", "localStorage", "sessionStorage", "addEventListener", "removeEventListener", "dispatchEvent"])
for (const name of new Set([...Object.getOwnPropertyNames(window), ...Object.getOwnPropertyNames(Window.prototype), ...OVER])) {
    if (name in globalThis && !OVER.has(name)) continue // Node's own, such as timers
    const own = (window as unknown as Record<string, unknown>)[name]
    const isFunction = typeof own === "function" && !/^[A-Z]/.test(name)
    const value: unknown = isFunction ? (own as (...given: unknown[]) => unknown).bind(window) : own
    Object.defineProperty(globalThis, name, { value, configurable: true, writable: true })
}
// What a page keeps in `window`, scripts find without naming it.
for (const name of ["window", "self", "parent", "top"]) Object.defineProperty(globalThis, name, { value: globalThis, configurable: true, writable: true })
Object.defineProperty(globalThis, "location", { value: window.location, configurable: true, writable: true })

const observers = new Map<Element, (size: { width: number; height: number }) => void>()
class FakeResizeObserver {
    constructor(private readonly tell: (entries: unknown[]) => void) {}
    observe(element: Element): void {
        observers.set(element, contentRect => this.tell([{ contentRect }]))
    }
    unobserve(element: Element): void { observers.delete(element) }
    disconnect(): void {}
}
const media = (query: string) => ({ matches: /reduce/.test(query), media: query, addEventListener(): void {}, removeEventListener(): void {} })
Object.assign(globalThis, { ResizeObserver: FakeResizeObserver, matchMedia: media })

/** Give an element a size, of which its observer hears. */
export function resize(element: Element, width: number, height: number): void {
    observers.get(element)?.({ width, height })
}

/** What is written on a canvas since it was cleared last. */
export class Ink {
    texts: { text: string; x: number; y: number }[] = []
    lines: (readonly [number, number])[][] = []
    private path: (readonly [number, number])[][] = []
    measureText(text: string): { width: number } { return { width: 7 * text.length } }
    clearRect(): void {
        this.texts = []
        this.lines = []
    }
    beginPath(): void { this.path = [] }
    moveTo(x: number, y: number): void { if (Number.isFinite(x + y)) this.path.push([[x, y]]) }
    lineTo(x: number, y: number): void {
        if (!this.path.length) this.moveTo(x, y)
        else if (Number.isFinite(x + y)) this.path.at(-1)!.push([x, y])
    }
    stroke(): void { this.lines.push(...this.path) }
    fillText(text: string, x: number, y: number): void { this.texts.push({ text, x, y }) }
    static readonly nothing = (): void => {}
}
for (const name of ["setTransform", "fill", "arc", "rect", "clip", "save", "restore", "setLineDash", "fillRect", "strokeText",
    "strokeRect", "closePath", "translate", "rotate", "scale", "drawImage", "ellipse", "bezierCurveTo", "quadraticCurveTo"])
    Object.assign(Ink.prototype, { [name]: Ink.nothing })

const inks = new WeakMap<object, Ink>()
Object.assign(window.HTMLCanvasElement.prototype, {
    getContext(this: object): Ink {
        const ink = inks.get(this) ?? new Ink()
        inks.set(this, ink)
        return ink
    },
})

export function inkOf(canvas: HTMLCanvasElement): Ink {
    return canvas.getContext("2d") as unknown as Ink
}

/** Texts that are their keys. */
export const TEXTS = {
    words: new Proxy<Record<string, string>>({}, { get: (_, key) => (key === "point" ? "." : String(key)), has: () => true }),
}

/** The element with a role and a name, as a reader finds it. */
export function found(within: Element, role: string, name: string): HTMLElement {
    const roles: Record<string, string> = { button: "button, [role=button]", combobox: "select", slider: "[role=slider], input[type=range]" }
    const all = [...within.querySelectorAll<HTMLElement>(roles[role] ?? `[role=${role}]`)]
    const one = all.find(each => [each.ariaLabel, each.getAttribute("aria-label"), each.textContent].includes(name))
    if (!one) throw new Error(`no ${role} named ${name}`)
    return one
}

export function press(element: Element, key: string): boolean {
    return element.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }))
}
