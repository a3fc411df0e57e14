// Whether the page is light or dark: as the system is, unless the user of this browser wants one of them.

import { keep, kept } from "../channel/kept"

export const LOOKS = ["system", "light", "dark"] as const
export type Look = (typeof LOOKS)[number]

const KEPT_AS = "look"

export function keptLook(): Look {
    return LOOKS.find(look => look === kept(KEPT_AS)) ?? "system"
}

/** Keep what the user wants; the page hears of it by the event `op-look`. */
export function keepLook(look: Look): void {
    keep(KEPT_AS, look)
    dispatchEvent(new Event("op-look"))
}
