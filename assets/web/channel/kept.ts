// What a browser keeps for the lab: the codes of its labs, a teacher's pass, and preferences. The names of the
// entries are those of earlier versions, in which viser kept them.

const FIRST = "viser-user:"
const MOST_CODES = 8
const DRIVES = "onpath-drives"
const LONGEST = 500 // [characters] of a value; the lab takes no longer ones
const BY_CLASS: readonly string[] = ["labs", "teacher"] // differ between the classes of a site
const NAMES: Record<string, string> = { labs: "onpath_sessions", teacher: "onpath_teacher" }

function entryOf(key: string): string {
    const room = /\/c\/([a-z0-9]{1,32})(?:\/|$)/.exec(location.pathname)?.[1]
    return FIRST + (NAMES[key] ?? key) + (room && BY_CLASS.includes(key) ? `_${room}` : "")
}

/** A value that the browser keeps, or nothing. */
export function kept(key: string): string {
    try {
        return (localStorage.getItem(entryOf(key)) ?? "").slice(0, LONGEST)
    } catch {
        return "" // a browser without storage starts over each time
    }
}

/** Keep a value, or forget it if it is empty. */
export function keep(key: string, value: string): void {
    try {
        if (value) localStorage.setItem(entryOf(key), value)
        else localStorage.removeItem(entryOf(key))
    } catch {}
}

/** Keep a lab's code before those of the browser's other labs. */
export function keepLab(code: string): void {
    const codes = new Set([code, ...(kept("labs").match(/\b[a-z0-9]{12}\b/g) ?? [])])
    keep("labs", [...codes].slice(0, MOST_CODES).join(","))
}

/** The key of the page that drives a plant, which its address had: the tab keeps it. */
export function driversKey(): string {
    const [, key = ""] = /^#drive=([0-9a-f]{1,64})$/.exec(location.hash) ?? []
    try {
        if (key) sessionStorage.setItem(DRIVES, key)
        else return sessionStorage.getItem(DRIVES) ?? ""
        history.replaceState(history.state, "", location.pathname + location.search)
    } catch {} // a browser without storage keeps it in the address
    return key
}

/** Where this site is, without the page's place in it. */
export function siteOf({ origin, pathname }: { origin: string; pathname: string }): string {
    return origin + pathname.replace(/(\/[cl]\/[a-z0-9]{1,32}(\/(wall|remote))?)?\/?(index\.html)?$/, "")
}

/** Let viser's page, when the lab asks it, say which page it belongs to. The answer is this page's alone: it is neither
 * in the storage, which other tabs share, nor in an address. */
export function sayToViser(answer: () => string): void {
    const entry = `${FIRST}page`
    try {
        const get = localStorage.getItem.bind(localStorage), ofSession = sessionStorage.getItem.bind(sessionStorage)
        Storage.prototype.getItem = function (name) {
            return name === entry ? answer() : this === sessionStorage ? ofSession(name) : get(name)
        }
    } catch { // viser would only report that there is no storage
        const none: Partial<Storage> = { getItem: name => (name === entry ? answer() : null), setItem() {}, removeItem() {}, length: 0 }
        Object.defineProperty(window, "localStorage", { value: none, configurable: true })
    }
}
