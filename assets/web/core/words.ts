// Texts and numbers in the language of the page.

/** Begins a line that warns, as in app/view/poles.py. */
export const WARNS = "⚠ "

/** The data of a page, with its messages. */
export interface Texts {
    words: Record<string, string>
}

/** A message with its values filled in. */
export function phrase(texts: Texts, key: string, values: Record<string, string> = {}): string {
    const text = texts.words[key]
    if (text === undefined) throw new Error(`no words for ${key}`)
    return filled(text, values)
}

export function filled(text: string, values: Record<string, string>): string {
    return text.replaceAll(/\{(\w+)\}/g, (whole, name: string) => values[name] ?? whole)
}

/** A formatted number with the decimal separator of the language in place of the point. */
export function localized(number: string, { words }: Texts): string {
    return number.replace(".", words["point"] ?? ".")
}

/** A number as the language writes it. */
export function written(texts: Texts, value: number, digits?: number): string {
    const text = digits === undefined ? String(value) : value.toFixed(digits).replace(/^-(?=[0.]*$)/, "")
    return localized(text.replace("-", "−"), texts)
}

/** The same with a number of significant digits. */
export function significant(texts: Texts, value: number, digits: number): string {
    return written(texts, Number(value.toPrecision(digits)))
}

/** A text without digits: the same text when only its numbers have changed. */
export function withoutNumbers(text: string): string {
    return text.replaceAll(/\d+/g, "")
}
