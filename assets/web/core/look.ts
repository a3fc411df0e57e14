// Whether the page is light or dark: as the system is, unless the user of this browser wants one of them.

export const LOOKS = ["system", "light", "dark"] as const
export type Look = (typeof LOOKS)[number]

const KEPT_AS = "viser-user:look"

export function keptLook(): Look {
    try {
        return LOOKS.find(look => look === localStorage.getItem(KEPT_AS)) ?? "system"
    } catch {
        return "system"
    }
}

export function keepLook(look: Look): void {
    try {
        localStorage.setItem(KEPT_AS, look)
    } catch {} // without storage it is as the system is
    dispatchEvent(new Event("op-look"))
}
