// The settings that a place shows, as data; made by app/channel/typescript.py from
// app/channel/form_messages.py: change them there.

/** A value that may be chosen. */
export interface FormOption {
    value: number | string | boolean
    label: string
    help?: string
    /** an outline: a path of SVG in a square from -50 to 50, up is negative. */
    picture?: string
}

/** A condition under which a field acts: another one has one of these values. */
export interface FormNeed {
    name: string
    /** none: any but 0, "off" and false. */
    of?: (number | string | boolean)[]
}

/** A row of a form. Its value is told by its name; a note's is what it says. The value of `poles` has a line for each pole:
 * its channel, its real and its imaginary part, [1/s]; that of "html" comes from a template that escapes what users have
 * typed. */
export interface FormField {
    name: string
    kind: "button" | "choice" | "html" | "note" | "number" | "poles" | "switch" | "text"
    label: string
    symbol?: string
    unit?: string
    /** what one will see, in a sentence. */
    help?: string
    /** range of a number. */
    low?: number
    /** range of a number. */
    high?: number
    /** range of a number. */
    step?: number
    /** of a number: the name of the value above which it is unstable. */
    limit?: string
    /** how many of `unit` make one unit of the value. */
    factor?: number
    scale?: "linear" | "log"
    /** the number to which a switch sets it, if 0 is off. */
    on?: number | null
    options?: FormOption[]
    /** what it needs in order to act: of each, one suffices. */
    needs?: FormNeed[][]
    /** to which one goes back; None: there is no way back. */
    default?: number | string | boolean | null
    /** the value of a lesson's step. */
    mark?: number | string | boolean | null
    /** the command that a button sends. */
    act?: Record<string, unknown> | null
    /** the question that it asks before it does. */
    asks?: string
    /** of a note or a button: "main", "warning" or none; of a note also the side whose colour it has, "of_left" or "of_right",
     * or "ranks", below the colours of the rank test's map. */
    tone?: string
    /** a heading above all fields of the same section. */
    section?: string
    /** the address of a button's picture. */
    picture?: string
    /** the sign that stands on a button instead of its label. */
    icon?: "" | "draw" | "redo" | "undo"
}

/** Fields that belong together. */
export interface FormGroup {
    name: string
    title: string
    fields: FormField[]
    /** "first": seen at once; "deeper": to be opened. */
    level?: "deeper" | "first"
    /** names of the fields whose values make its line while it is closed. */
    states?: string[]
}

/** All fields of a place; without groups, there is no such place now. */
export interface FormMessage {
    is: "form"
    place: "class" | "figure" | "lab" | "step"
    groups: FormGroup[]
}

/** Values of fields: all of them at first, then those that have changed. */
export interface ValuesMessage {
    is: "values"
    values: Record<string, number | string | boolean>
    /** why the last value of a setting was refused; empty: it was not. */
    refused?: Record<string, string>
    /** of each setting of the page, the number of its last message that counts here. */
    heard?: Record<string, number>
}
