// Elements of the page, and keys.

export function made<T extends keyof HTMLElementTagNameMap>(
    tag: T,
    name: string,
    ...inside: (Node | string)[]
): HTMLElementTagNameMap[T] {
    const element = document.createElement(tag)
    if (name) element.className = name
    element.append(...inside)
    return element
}

/** An element of a picture in SVG. */
export function svg<T extends keyof SVGElementTagNameMap>(
    tag: T, attributes: Record<string, string | number>, ...inside: (Node | string)[]
): SVGElementTagNameMap[T] {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag)
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value))
    element.append(...inside)
    return element
}

/** The elements of our own server's HTML, whose templates escape whatever users have typed. */
export function elementsOf(html: string): DocumentFragment {
    const template = document.createElement("template")
    template.innerHTML = html // oxlint-disable-line no-restricted-properties
    return template.content
}

/** A checkbox that looks like a switch, and is called one. */
export function switchInput(properties: { id?: string; title?: string; checked?: boolean } = {}): HTMLInputElement {
    const input = Object.assign(made("input", "switch"), { type: "checkbox", ...properties })
    input.setAttribute("role", "switch")
    return input
}

/** Set an element's text if it differs, so that a screen reader does not repeat it. Its node stays: for another node a browser
 * matches all rules with :has() again, which on the lab's page took a quarter of the time of each picture. */
export function tell(element: HTMLElement, text: string): void {
    if (element.textContent === text) return
    if (text && element.childNodes.length === 1 && !element.firstElementChild) element.firstChild!.nodeValue = text
    else element.textContent = text
}

/** Say why something was refused, and bring it into sight; an empty text: it was not. */
export function refuse(element: HTMLElement, why: string): void {
    if (element.textContent === why) return
    element.textContent = why
    if (why) element.scrollIntoView({ block: "nearest" })
}

/** Let the browser save a file. */
export function save(name: string, content: Blob): void {
    const link = made("a", "")
    link.href = URL.createObjectURL(content)
    link.download = name
    link.click()
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000) // some browsers read it later
}

/** Whether a key belongs to the browser or to the focused field. */
export function isTyped({ ctrlKey, metaKey, altKey, target }: KeyboardEvent): boolean {
    const field = (target as Partial<HTMLElement>).closest?.("textarea, select, input:not([type=range])")
    return ctrlKey || metaKey || altKey || Boolean(field)
}

/** The name of a key in small letters; a letter of another alphabet counts as the Latin one on its key,
 * as in assets/page/keys.js for the lab. */
export function keyOf({ key, code }: KeyboardEvent): string {
    const foreign = /^\p{L}+$/u.test(key) && !/[a-z]/i.test(key)
    return ((foreign && /^Key([A-Z])$/.exec(code)?.[1]) || key).toLowerCase()
}
