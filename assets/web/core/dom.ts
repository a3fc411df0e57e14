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

/** Set an element's text if it differs, so that a screen reader does not repeat it. */
export function tell(element: HTMLElement, text: string): void {
    if (element.textContent !== text) element.textContent = text
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
