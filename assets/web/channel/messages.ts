// The messages of the channel between a page and its lab, made by app/channel/typescript.py from
// app/channel and app/lab/commands: change them there.

import type { FormMessage, ValuesMessage } from "../core/form_data"
import type { Curves, RowData, Verdict } from "../core/shared_data"
import type { ChartData, StepData } from "../core/lesson_data"
import type { Notes } from "../lessons/notes"

export const PROTOCOL = "onpath-3"

/** Control laws of the sides; an empty one is that of a new lab, or stays as it is. */
export interface Laws {
    left?: string
    right?: string
}

/** The start of both robots relative to the path; all values are 0 in a new lab. */
export interface RunStart {
    /** path parameter of the point near which they start, [rad]. */
    place?: number
    /** distance from that point, positive to the left of the path, as ξ₁, [mm]. */
    across?: number
    /** along the path, [mm/s]. */
    speed?: number
    /** velocity across the path, as ξ₂, [mm/s]. */
    across_rate?: number
    /** how far ahead the clock starts, for a law that has one, [rad]. */
    lead?: number
}

/** One action on the lab. Exactly one of the fields other than `at` and `only` is given. */
export interface Action {
    /** time since the script began, [s]. */
    at?: number
    /** put the brake on, or off. */
    hold?: boolean | null
    /** pull the end-points from where they are by (right, up), [mm], in the path's plane. */
    pull?: [number, number] | null
    /** end a pull. */
    release?: boolean | null
    /** parameters and settings of the lab. */
    set?: Record<string, boolean | number | string> | null
    /** name of a preset. */
    path?: string | null
    /** move a control point (index, right, up), by [mm]. */
    move?: [number, number, number] | null
    /** change the robot. */
    robot?: string | null
    /** change the control laws of the sides. */
    laws?: Laws | null
    /** put both robots back to the start. */
    reset?: boolean | null
    /** run or pause. */
    run?: boolean | null
    /** fit the controller's model to the measured motion. */
    identify?: boolean | null
    /** put both robots to another start, and restart there. */
    start?: RunStart | null
    /** how fast time goes from now on, compared with the student's own tempo; 0.25 is slow motion. */
    rate?: number | null
    /** the robot that hold and pull act on; empty for both. */
    only?: "follower" | "tracker" | ""
}

/** The first message of a page. */
export interface Hello {
    is: "hello"
    /** a random number of its own, by which viser's websocket is known to be the same page's. */
    page: string
    /** the codes of the browser's labs, newest first, separated by commas. */
    labs?: string
    /** the pass of a teacher of the class at the page's address. */
    teacher?: string
    /** where the browser has opened the site. */
    site?: string
    /** whether the browser asks for dark pages. */
    dark?: boolean
    /** whether it draws in software, so that the scene must be quickly drawn. */
    plain?: boolean
    /** whether its window is so; letters in the scene are larger then. */
    upright?: boolean
    /** see `Store`. */
    speaks?: string
    /** see `Store`. */
    sounds?: string
    /** see `Store`. */
    first_minute?: string
    /** the key of the page that drives a plant, as its address had it. */
    drives?: string
}

/** The page is drawn: comes every two seconds. A lab that nobody sees rests. */
export interface Seen {
    is: "seen"
}

/** The browser now asks for dark pages, or for light ones. */
export interface Dark {
    is: "dark"
    on: boolean
}

/** The canvas has another size: the camera is then fitted to it. */
export interface Resized {
    is: "resized"
    /** see `Hello`. */
    upright?: boolean
}

/** The user wants no introduction any more. */
export interface Skip {
    is: "skip"
}

/** Tell the form and the values of its fields, from now on. */
export interface AskForm {
    is: "fields"
}

/** A field of the form has another value. */
export interface SetField {
    is: "set"
    name: string
    value: boolean | number | string
    /** larger than that of all messages before; see `ValuesMessage.heard`. */
    number: number
}

/** Tell where a symbol is found on the robots, until another one is asked for. */
export interface Light {
    is: "light"
    /** "bars" for the ends of all bars, two for each; empty to be told nothing more. */
    symbol: "delta" | "q_1" | "q_2" | "rho" | "" | "bars"
}

/** Tell more of each sample, also of the past, until another one comes. */
export interface Plot {
    is: "plots"
    /** that the page plots; see `ASKED` in app/lab/plot_rows.py. */
    fields: string[]
}

/** A file with a path that the robots are to follow. */
export interface PathFile {
    kind: "path"
    /** of the path, [mm]; 0: as the file states it. */
    size?: number
    /** with which its corners are rounded, [mm]; 0: it is smoothed. */
    radius?: number
    /** whether it is open, although its ends meet. */
    opened?: boolean
    /** angle by which it is turned anticlockwise, [degrees]. */
    turn?: number
    /** coordinates of its middle in the plane of the path, [mm]. */
    right?: number
    /** coordinates of its middle in the plane of the path, [mm]. */
    up?: number
    /** numbers of the wanted lines of the file, from 1; none: all of them. */
    parts?: number[]
}

/** The log of a real arm, which is drawn over the plots. */
export interface LogFile {
    kind: "log"
    /** the file's names, or places, of the robot's quantities, by name; what is missing is guessed. */
    columns?: Record<string, string>
    /** of these columns, or their sizes in SI units; those that are missing are guessed. */
    units?: Record<string, string>
}

/** A file will come in parts: the first after the answer to this, `FileMessage`, and each further one after the answer to
 * the one before. */
export interface SendFile {
    is: "send"
    /** names the file in what follows. */
    number: number
    /** of the file. */
    name: string
    /** [B]. */
    size: number
    /** what is done with it. */
    use: PathFile | LogFile
    /** number of the same file when it was sent before, whose content need not come again; 0 if it was not. */
    again?: number
}

/** The next part of a file. */
export interface SendPart {
    is: "part"
    /** of the file. */
    number: number
    /** at most 180 kB, in base64. */
    content: string
}

/** No more of a file will come. */
export interface DropFile {
    is: "drop"
    /** of the file. */
    number: number
}

/** Make a file for a download; one at a time. Answered by `DownloadMessage`. */
export interface MakeFile {
    is: "make"
    /** a table of the last minute (CSV), a picture of its plots or of the lines that the robots have written (PNG), a page with
     * the scene of its last seconds, or a page with the record of all lessons. */
    file: "film" | "lines" | "picture" | "report" | "table"
    /** whether the record shows the lab's code, which then opens the lab. */
    with_code?: boolean
}

/** An order of a teacher to the class; refused from any other page. */
export interface Lead {
    is: "lead"
    do: "ask_again" | "back" | "close_votes" | "delete" | "end" | "end_standing" | "forget" | "freeze" | "give_place" | "keep" | "keep_apart" | "let_go" | "let_in" | "next" | "open_votes" | "own_lab" | "play" | "put_back" | "record" | "remove" | "send_route" | "send_setup" | "send_step" | "set_aside" | "stop" | "thaw" | "throw_out" | "timer"
    /** number of the student whom it concerns, or of the phone. */
    member?: number
}

/** From the page that drives a plant: start it, stop it, or only a sign of life. */
export interface DrivePlant {
    is: "drive"
    what: "beat" | "start" | "stop"
    /** the torque after the end, of a start. */
    at_fault?: "damp" | "hold" | "zero"
}

/** Tell what a sheet shows; the answer's `is` is its name. */
export interface Ask {
    is: "ask"
    what: "compare" | "display" | "help" | "index" | "keep" | "laws" | "lessons" | "robots"
}

/** The next stroke around a robot becomes the path; asked for again, no stroke does. */
export interface Freehand {
    is: "freehand"
}

/** Keep a switch in the browser; see `app.view.preferences`. */
export interface Prefer {
    is: "prefer"
    name: "sounds" | "speaks"
    on: boolean
}

/** Show the robots as at the beginning. */
export interface ResetView {
    is: "view"
}

/** Describe what is on the screen. */
export interface AskSummary {
    is: "summary"
}

/** Go to the lab of a code; if that is refused, `Told` says why. */
export interface EnterLab {
    is: "enter"
    code: string
}

/** Have the robot of a file with another of the tips that the file suggests.
 *
 * It may have to be built first; the lab says how far that is, and why if it fails. */
export interface ChooseTip {
    is: "choose_tip"
    /** the name of a robot of the file. */
    robot: string
    tip: string
}

/** Compare laws under an obstruction; `Compared` tells the results, and `Told` why not. */
export interface CompareLaws {
    is: "compare_laws"
    laws: string[]
    obstruction: string
}

/** Join a class; answered by `SeatAnswer`. */
export interface JoinClass {
    is: "join"
    /** of the class; only needed where the page's address has none. */
    code: string
    /** the nickname. */
    name: string
}

/** Leave the class; answered by `SeatAnswer`. */
export interface LeaveClass {
    is: "leave"
}

/** Ask the teacher for the place of the same name that is away; see `ClassMessage.away`. */
export interface AskPlace {
    is: "ask_place"
}

/** Delete the lab with everything that is stored of the student, and leave the class. */
export interface ForgetMe {
    is: "forget_me"
}

/** Say by what a platform knows the student, if the teacher has asked for it; or take it back.
 *
 * Answered by `SeatAnswer`. */
export interface IdentifyMyself {
    is: "identify"
    typed: string
}

/** Give a word of the student's own, which links two tests, or take it back with an empty one.
 *
 * Answered by `SeatAnswer`. */
export interface LinkWord {
    is: "link"
    word: string
}

/** Open the teacher's page with the teacher's key.
 *
 * Answered by `SeatAnswer`, unless the page becomes the teacher's. */
export interface Teach {
    is: "teach"
    key: string
}

/** What changes the lab; see app/lab/commands. */
export type Command =
    | { do: "Act"; actions: Action[] }
    | { do: "AddPoint" }
    | { do: "AnswerInWords"; lesson?: string; step?: number; key?: string; block: number; typed: string }
    | { do: "AnswerNumber"; lesson?: string; step?: number; key?: string; block: number; given: number; second?: boolean }
    | { do: "AnswerQuiz"; lesson?: string; step?: number; key?: string; block: number; option: number; second?: boolean }
    | { do: "BeginStepAnew" }
    | { do: "ChooseLaw"; side: string; law: string }
    | { do: "ChoosePath"; name: string }
    | { do: "ChooseRobot"; name: string }
    | { do: "CloseLesson" }
    | { do: "DragJoint"; joint: number; target: number[] | number[][] }
    | { do: "DrawPath"; stroke: number[] | number[][] }
    | { do: "EndMove" }
    | { do: "FinishLesson" }
    | { do: "FollowRoute"; name: string }
    | { do: "GoOn" }
    | { do: "GoToStep"; by: number }
    | { do: "Grab"; side: string; target: number[] | number[][] }
    | { do: "Hold"; on?: boolean | null; side?: string | null }
    | { do: "Identify" }
    | { do: "LookAt"; ago: number }
    | { do: "LookBack"; by: number }
    | { do: "MoveHand"; right: number; up: number }
    | { do: "MovePoint"; index: number; target: number[] | number[][]; finished?: boolean }
    | { do: "MoveStart"; target: number[] | number[][] }
    | { do: "MoveWall"; target: number[] | number[][] }
    | { do: "NudgePoint"; right: number; up: number }
    | { do: "NudgeWall"; right?: number; up?: number; turn?: number }
    | { do: "OpenLesson"; name: string }
    | { do: "PlacePoint"; first?: number | null; second?: number | null }
    | { do: "PlayStep" }
    | { do: "Predict"; lesson?: string; step?: number; key?: string; option?: number | null; times?: number[]; values?: number[]; sure?: "" | "certain" | "fairly" | "guessing"; reason?: number | null; why?: string }
    | { do: "Pulse" }
    | { do: "Redo" }
    | { do: "Release"; side?: string | null }
    | { do: "RemoveLog" }
    | { do: "RemovePoint" }
    | { do: "ReplayBreakdown" }
    | { do: "Reset" }
    | { do: "ResetParameters" }
    | { do: "SelectNext" }
    | { do: "SelectPoint"; index: number | null }
    | { do: "Set"; name: string; value?: boolean | number | string | null }
    | { do: "SetLanguage"; language: string }
    | { do: "SetRunning"; running?: boolean | null }
    | { do: "Share" }
    | { do: "ShowHint"; task: string }
    | { do: "StartOnPath" }
    | { do: "StepOnce" }
    | { do: "SwingWall"; end: number; target: number[] | number[][] }
    | { do: "TypeLaw"; side: string; text: string }
    | { do: "Undo" }
    | { do: "UndoGoOn" }
    | { do: "UseEarlierSettings" }
    | { do: "UseShared"; text: string }

/** What a page sends besides commands. */
export type PageMessage =
    | Hello
    | Seen
    | Dark
    | Resized
    | Skip
    | AskForm
    | SetField
    | Light
    | Plot
    | SendFile
    | SendPart
    | DropFile
    | MakeFile
    | Lead
    | DrivePlant
    | Ask
    | Freehand
    | Prefer
    | ResetView
    | AskSummary
    | EnterLab
    | ChooseTip
    | CompareLaws
    | JoinClass
    | LeaveClass
    | AskPlace
    | ForgetMe
    | IdentifyMyself
    | LinkWord
    | Teach

/** The code of the page's lab, which its browser keeps before those of its other labs. */
export interface LabCode {
    is: "lab"
    code: string
}

/** The browser is to keep a value for `Hello`, or to forget it if it is empty. */
export interface Store {
    is: "store"
    /** "teacher": a pass, of the class at the page's address; "speaks" and "sounds": "yes" or "no"; "first_minute": how many of
     * the invitations it has shown. */
    key: "first_minute" | "sounds" | "speaks" | "teacher"
    value: string
}

/** The page has no lab yet: the server is full. */
export interface Wait {
    is: "wait"
    /** says so to the user. */
    text: string
}

/** The page's texts by key; when its language changes. */
export interface WordsMessage {
    is: "words"
    language: string
    words: Record<string, string>
}

/** The samples since the last frame; 20 times a second while anything in it changes, less often under load or if the page
 * reads slowly.
 *
 * A row is `[time, flags, …left robot, …right robot]`. The flags are bits: left held, right held, left pulled, right
 * pulled. A robot has p + p + 3 numbers, where p is 2 or 3: its distance from the path, θ of the closest point, θ of the
 * reference point, end-point (p), external force on it (p). Times are in 0.1 ms, lengths in 10 µm, angles in 0.1 mrad,
 * forces in 10 mN. End-points are coordinates of the output space, `Robot.position` of which is where they are drawn.
 * After both robots come the numbers of `fields`, all of the left robot, then all of the right one; null where ξ had
 * another unit than now. */
export interface FrameMessage {
    is: "frame"
    /** 60 per second, the oldest first; the last one is the present. They replace all samples of the page from the time of the
     * first one on. */
    rows: ((number | null)[])[]
    /** whether time runs. */
    running: boolean
    /** the past instant that the lab shows [s], or null. */
    past: number | null
    /** whether the page must forget all its samples first; `rows` has the last minute. */
    anew?: boolean
    /** with `anew`: for each field that the page has asked for and the robots have, its name, how many of its numbers are told,
     * and how many units an SI unit has. */
    fields?: [string, number, number][]
    /** only for a link that bends: for each of the last rows, where the end-points would be if it did not, as end-points are
     * given in a row. */
    straight?: number[][]
}

/** The drawn path, when it changes. */
export interface PathMessage {
    is: "path"
    /** of the output space, at evenly spaced θ from -π to π, in 10 µm. A closed path is periodic, an open one goes on along its
     * end tangents. */
    points: number[][]
    /** whether it is closed. */
    closed: boolean
    /** where the pen is up: θ from and to, [rad]. */
    raised: [number, number][]
    /** two unit vectors at right angles, in which the path is seen from in front. */
    right: number[]
    /** two unit vectors at right angles, in which the path is seen from in front. */
    up: number[]
}

/** The log of a real arm that is drawn over the plots, when it or the path changes. */
export interface LogMessage {
    is: "log"
    /** name of its file; empty: there is no log. */
    file: string
    /** of its rows, [s]. */
    times: number[]
    /** names of fields as in `FrameMessage`, with the number of units that an SI unit has, and each of its numbers in all rows;
     * null where it is not known, as in a gap. */
    fields: ([string, number, ((number | null)[])[]])[]
}

/** Where the symbol is found that is asked for, whenever the robots have moved, at most 20 times a second. */
export interface LitMessage {
    is: "lit"
    /** what is asked for. */
    symbol: string
    /** for each robot the points of a line, or one point for a joint, in 10 µm of the output space. */
    lines: number[][][]
}

/** What a page says beyond the lab's message. */
export interface Said {
    /** for a screen reader; empty if the user does not want it. */
    voice: string
    /** a description of the screen. */
    summary: string
    /** number of requests for it so far. */
    summaries: number
    /** whether the message says why a robot has stopped. */
    stopped: boolean
    /** whether its last moments are to be shown, unless the user wants less motion. */
    replays: boolean
    /** label of the button that restores the last good settings; empty if there are none. */
    earlier: string
    /** whether the distances are to be heard. */
    sounds: boolean
    /** name of what a newcomer is invited to do; empty: nothing. */
    invitation: string
    /** the command that follows it; null: it is followed in the scene itself. */
    act: Command | null
}

/** What is known of the plant. */
export interface PlantMessage {
    /** "off" before the start; "starting" until its controller listens; "waiting" for its first measurement; "running";
     * "ended". */
    phase: "ended" | "off" | "running" | "starting" | "waiting"
    /** the same in a sentence, and why it has ended. */
    text: string
    /** how late its torques were; empty before there are any. */
    late: string
    /** whether it can be stopped. */
    live: boolean
    /** whether it can be started. */
    ready: boolean
    /** its torque after the end, "zero", "hold" or "damp". */
    at_fault: string
}

/** What the lab is called and set to: everything at first, then what has changed, at most ten times a second. */
export interface StateMessage {
    is: "state"
    /** of the texts. */
    language: string
    /** its name. */
    robot: string
    /** of the robots: names of their control laws. */
    titles: string[]
    /** what a lesson calls the robots; else the same. */
    names: string[]
    /** what the laws do. */
    texts: string[]
    /** what each robot does now; may be empty. */
    captions: string[]
    /** whether a law aims at the reference point by its clock; else it aims at the closest point. */
    clocks: boolean[]
    /** whether a robot has diverged and stands still. */
    stopped: boolean[]
    /** simulated seconds per second, as wanted. */
    rate: number
    /** what was reached lately. */
    achieved: number
    /** whether a discarded past can be restored. */
    undo: boolean
    /** for the user. */
    message: string
    /** how severe the message is; empty without one. */
    level: string
    /** how many have been shown so far: the same one may be shown again. */
    messages: number
    /** what is spoken, and what newcomers are invited to do. */
    said: Said
    /** whether large type for a projector is on. */
    presenting: boolean
    /** how high a part of the scene the canvas shows, at the distance of the robots [m]. */
    height: number
    /** for each robot, how the picture shows a point of the output space: three rows of p factors and a constant; the first two
     * results divided by the third are right and down from the middle, as shares of the height. */
    cameras: number[][][]
    /** the point of the output space over which a robot's title stands. */
    above: number[]
    /** length of the arrow of a force [m/N]. */
    arrow: number
    /** why the lab takes no commands, if the teacher has stopped it; else empty. */
    frozen: string
    /** displayed name of the kind of robot. */
    machine: string
    /** whether the picture shows these robots, as `cameras` tells. */
    drawn: boolean
    /** that time waits for what takes long; else empty. */
    waits: string
    /** whether commands are taken: not if a teacher looks at the lab of a student. */
    own: boolean
    /** what can be plotted of these robots. */
    rows: RowData[]
    /** names of the robots' control laws; a typed one is its own name. */
    laws: string[]
    /** the share code that was made last; may be empty. */
    shared: string
    /** keys of the latest answers that are stored, and of those that cannot be taken: they need not be sent again. */
    sent: string[]
    /** how many times the page had asked for a picture of the robots when it asked for the present one; 0 without one. */
    scene: number
    /** that stands in the place of the right robot; null: none. */
    plant: PlantMessage | null
}

/** The open step of a lesson, or its end; when another one is open, or anything is noted in it. A teacher's page has none.
 *
 * What is right is told only once the student has answered, or has seen what happens; in a test never. */
export interface LessonMessage {
    is: "lesson"
    /** its name; empty: no lesson is open, and the other fields but `version` are, too. */
    lesson: string
    /** changes with every message. */
    version: number
    /** number of the open step, from 0. */
    index: number
    /** whether the end is shown. */
    ended: boolean
    /** whether it is the concept test. */
    test: boolean
    /** whether the lab plays the step's script. */
    playing: boolean
    /** names of the lesson's symbols that mean something on this robot, and what they mean. */
    symbols: Record<string, string>
    /** HTML of what stands above and below the text. A button's `data-send` has the messages that it sends. */
    head: string
    /** HTML of what stands above and below the text. A button's `data-send` has the messages that it sends. */
    pager: string
    /** HTML by number of the step: the open one, and the one whose prediction it shows; `end` for the end of a lesson. Both
     * come from `assets/templates/step`, as on the course site. */
    sections: Record<string, string>
    /** what the script needs of each step; parts and plots only of those in `sections`. */
    steps: StepData[]
    /** the answers of the open step. */
    notes?: Notes
    /** at the end: the curves of each prediction, in the order of the elements `[data-chart]`. */
    charts: ChartData[]
}

/** What is measured in the open step of a lesson, at most ten times a second. */
export interface MeasuredMessage {
    is: "measured"
    /** on each check of each task. */
    verdicts: Record<string, Verdict[]>
    /** while a script runs: the curves so far of the predicted quantity, three times a second; else null. */
    truth: Curves | null
}

/** What would help where a path cannot be followed. */
export interface PathHelp {
    /** of its button. */
    text: string
    /** of `PathFile`, with which the path can be followed, [mm]. */
    size: number
    /** of `PathFile`, with which the path can be followed, [mm]. */
    radius: number
}

/** A quantity of the robot in a log. */
export interface LogQuantity {
    /** such as "q1". */
    name: string
    /** of the file that is read as it; empty if there is none. */
    column: string
    /** in which it is read. */
    unit: string
    /** those that it may have. */
    units: string[]
    /** whether the file need not have it. */
    is_optional: boolean
}

/** How far the server is with a file of the page. */
export interface FileMessage {
    is: "file"
    /** of the file. */
    number: number
    /** more of it is awaited, it is being read, it has been used, or it is refused. */
    state: "awaited" | "reading" | "refused" | "used"
    /** how much has come, [B]. */
    received: number
    /** it is refused, in a sentence in the page's language; else empty. */
    why: string
    /** those in the file as they lie in it, each x, y, x, y, … from 0 to 1000; y points up. */
    lines: number[][]
    /** what would help. */
    helps: PathHelp[]
    /** names of a log's columns. */
    columns: string[]
    /** what is read from them. */
    quantities: LogQuantity[]
}

/** How far the server is with a file for the page. */
export interface DownloadMessage {
    is: "download"
    /** names the file in what follows. */
    number: number
    /** of the file. */
    name: string
    /** it is being made, its parts come now, or it cannot be made. */
    state: "coming" | "failed" | "making"
    /** the same in the page's language. */
    text: string
    /** of a file whose parts come now, [B]; else 0. */
    size: number
}

/** The next part of a file for the page. */
export interface DownloadPart {
    is: "part"
    /** of the file. */
    number: number
    /** in base64. */
    content: string
}

/** Comes whenever nothing else has been told for a second. */
export interface Alive {
    is: "alive"
}

/** A message of the page was refused.
 *
 * What a command cannot do is told in `StateMessage.message`. */
export interface Refused {
    is: "refused"
    /** in English, for programmers. */
    why: string
}

/** A robot to choose. */
export interface RobotCard {
    name: string
    label: string
    /** what is special about it, in a few words. */
    differs: string
    /** what it is, in a sentence or two. */
    text: string
    /** a data URI. */
    picture: string
    /** what chooses it. */
    send: Command | PageMessage
    /** the end-point of a robot from a file that suggests several. */
    tip: string
    /** whether it is in the catalogue; else the name is that of the robot with another tip. */
    is_built: boolean
}

/** All robots. */
export interface RobotSheet {
    is: "robots"
    robots: RobotCard[]
}

/** A law in four sentences, and its source. */
export interface LawDescription {
    name: string
    label: string
    does: string
    good: string
    limits: string
    objection: string
    source: string
}

/** Names that a typed law may use, which mean the same in several spellings. */
export interface NameMeaning {
    names: string
    means: string
    unit: string
}

/** The laws that suit the robot; what bounds all of them; how to type one. */
export interface LawSheet {
    is: "laws"
    laws: LawDescription[]
    bounds: string
    own: string[]
    names: NameMeaning[]
}

/** A law that can be compared; a typed one is its own name. `chosen`: at first. */
export interface LawChoice {
    name: string
    label: string
    text: string
    chosen: boolean
}

/** An obstruction. */
export interface ObstructionChoice {
    name: string
    label: string
}

/** What can be compared, and at most how many laws at once. */
export interface CompareSheet {
    is: "compare"
    laws: LawChoice[]
    obstructions: ObstructionChoice[]
    most: number
}

/** The code of the lab, and a sentence for how long it is kept; both empty if it is not. */
export interface KeepSheet {
    is: "keep"
    code: string
    until: string
}

/** A lesson or a test to open. */
export interface LessonCard {
    name: string
    /** empty for a test. */
    number: string
    /** a data: URL, or empty. */
    picture: string
    title: string
    summary: string
    /** how long it takes, and the like. */
    facts: string[]
    /** share of what is required that is done. */
    done: number
    /** how far the student is. */
    begun: boolean
    /** how far the student is. */
    finished: boolean
}

/** A route to follow. */
export interface RouteCard {
    name: string
    title: string
    summary: string
    minutes: string
    stops: string[]
}

/** The course, in its order; `open` is the name of the open lesson, or empty. */
export interface LessonSheet {
    is: "lessons"
    open: string
    lessons: LessonCard[]
    routes: RouteCard[]
}

/** One idea in the lessons' words and in the field's. */
export interface GlossaryEntry {
    plain: string
    term: string
    means: string
    lesson: string
}

/** The glossary in the lessons' order. */
export interface HelpSheet {
    is: "help"
    glossary: GlossaryEntry[]
}

/** A language and its name in it. */
export interface LanguageName {
    code: string
    name: string
}

/** The languages, and the browser's switches. */
export interface DisplaySheet {
    is: "display"
    languages: LanguageName[]
    speaks: boolean
    sounds: boolean
}

/** Something that the search finds besides settings. */
export interface Found {
    /** "robot", "law", "path", "lesson" or "key". */
    kind: string
    /** its name. */
    label: string
    /** a sentence. */
    text: string
    /** the messages that it sends when it is chosen. */
    send: (Command | PageMessage)[]
}

/** A keyboard shortcut. */
export interface ShownKey {
    name: string
    /** as a browser names it, in small letters. */
    key: string
    /** whether the control or command key is held down with it. */
    control: boolean
    /** the name of the shortcut on a keyboard. */
    shown: string
    /** what it does, in a sentence. */
    does: string
    /** the message to send. */
    send: Command | PageMessage
}

/** Everything that the search finds besides settings, and the keys. */
export interface Index {
    is: "index"
    found: Found[]
    keys: ShownKey[]
}

/** A law under an obstruction, at its worst place each. */
export interface ComparedLaw {
    law: string
    label: string
    /** the largest, [mm], [s] and [N]; 0 if it was stopped. */
    distance: number
    /** the largest, [mm], [s] and [N]; 0 if it was stopped. */
    delay: number
    /** the largest, [mm], [s] and [N]; 0 if it was stopped. */
    force: number
    /** whether its motion diverged. */
    stopped: boolean
    /** what it asks of the motors beyond the limits of the robot's file; may be empty. */
    beyond: string
    /** between the points of its curve, [s]. */
    step: number
    /** distance to the path over time, where it becomes largest, [mm]. */
    curve: number[]
}

/** The results so far, of `all` laws; `acts`: from when until when the obstruction acts, [s]. */
export interface Compared {
    is: "compared"
    rows: ComparedLaw[]
    all: number
    acts: [number, number]
}

/** Says something in an open sheet, whose name is `of`. */
export interface Told {
    is: "told"
    of: "compare" | "keep"
    text: string
}

/** The lab's place in a class: when the page connects, and when it changes. */
export interface ClassMessage {
    is: "class"
    /** "none": there is nothing to join, or the page is a teacher's; "elsewhere": the server has classes at other addresses;
     * "guest": the page's address is that of a class, which the lab has not joined; "member": it has. */
    membership: "elsewhere" | "guest" | "member" | "none"
    /** the class's, as on the projector; empty if the address has none. */
    code: string
    /** the nickname of a member. */
    name: string
    /** how many visible characters a nickname may have. */
    longest: number
    /** what is stored of a student, and for how long. */
    stored: string
    /** the address of the site's privacy notice; empty if it has none. */
    privacy: string
    /** the nickname of somebody who is away, and may be the same student; else empty. */
    away: string
    /** whether the teacher has been asked to give that place back. */
    asked: boolean
    /** by what a member is to identify oneself, as the label of the field; empty: by nothing. */
    asks: string
    /** what the member has typed there. */
    identification: string
    /** whether the member has given the word that links two tests; "shared": so that another one has. */
    linked: "" | "own" | "shared"
}

/** What has come of a `SeatRequest`. */
export interface SeatAnswer {
    is: "seat"
    /** the request. */
    of: "ask_place" | "forget_me" | "identify" | "join" | "leave" | "link" | "teach"
    /** it was refused: a sentence in the page's language; else empty. */
    why: string
    /** where the page of the class is, if it is another one; else empty. */
    address: string
}

/** What the class's wall shows besides the robots, whenever it changes. It has no names and, until the teacher shows the
 * answers, nothing that depends on them. */
export interface WallMessage {
    is: "wall"
    /** how students join: address, QR code and class code, as HTML. */
    join: string
    /** what the class is asked and, once they are shown, its answers, as HTML. */
    asked: string
    /** seconds until the vote is closed; null if it is not being closed. */
    closing: number | null
    /** that the vote is closed; else empty. */
    note: string
}

/** What a remote control is told besides the form of the class, whenever it changes. */
export interface RemoteMessage {
    is: "remote"
    /** that it shows until it is let in; empty once it is. */
    number: string
    /** what to do with the number. */
    text: string
    /** whether a vote is open, so that the phone is to stay awake. */
    votes: boolean
}

/** A message with only the fields that have changed. */
export type Changes<Message extends { is: string }> = Pick<Message, "is"> & Partial<Message>

/** What the server sends. */
export type LabMessage =
    | LabCode
    | Store
    | Wait
    | WordsMessage
    | FrameMessage
    | PathMessage
    | LogMessage
    | LitMessage
    | Changes<StateMessage>
    | LessonMessage
    | MeasuredMessage
    | FormMessage
    | ValuesMessage
    | FileMessage
    | DownloadMessage
    | DownloadPart
    | Alive
    | Refused
    | RobotSheet
    | LawSheet
    | CompareSheet
    | KeepSheet
    | LessonSheet
    | HelpSheet
    | DisplaySheet
    | Index
    | Compared
    | Told
    | ClassMessage
    | SeatAnswer
    | WallMessage
    | RemoteMessage
