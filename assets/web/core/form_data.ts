// The settings that a place shows, as data: see app/view/forms.py. What has its default is left out.

export type Value = number | string | boolean

/** A setting acts only while another one has one of these values; of none: while it is neither 0 nor off. */
export interface Need { name: string; of?: Value[] }

export interface FormOption {
    value: Value
    label: string
    help?: string
    /** An outline: a path of SVG in a square from -50 to 50, up is negative. */
    picture?: string
}

export interface FormField {
    name: string
    kind: "number" | "choice" | "switch" | "button" | "text" | "note"
    label: string
    symbol?: string
    unit?: string
    /** What one will see, in a sentence. */
    help?: string
    low?: number
    high?: number
    step?: number
    /** How many of `unit` make one unit of the value. */
    factor?: number
    scale?: "linear" | "log"
    /** The number to which a switch sets it; 0 is off. */
    on?: number | null
    options?: FormOption[]
    needs?: Need[]
    default?: Value | null
    /** The value of a lesson's step. */
    mark?: Value | null
    /** The message of a button. */
    act?: Record<string, unknown> | null
    tone?: string
    /** A heading above the fields of the same section. */
    section?: string
}

export interface FormGroup {
    name: string
    title: string
    /** What is seen at once, or what one opens. */
    level?: "first" | "deeper"
    fields: FormField[]
    /** Names of the fields whose values make its line while it is closed. */
    states?: string[]
    /** Its line while nothing of it is on. */
    rest?: string
}

export interface FormMessage {
    is: "form"
    place: "lab" | "step" | "figure"
    groups: FormGroup[]
    /** What the place lacks, in one line; empty if nothing. */
    lacks?: string
}

export interface ValuesMessage {
    is: "values"
    values: Record<string, Value>
    refused?: Record<string, string>
}
