// The poles of a linear law, and what the page says about them, as `channels` of models/control/poles.py and
// app/view/poles.py. With w = z - 1 the characteristic polynomial of a channel follows from the transfer functions of its
// states, so that it is exact to rounding near w = 0, where the slow poles are.

import type { FigureData, PoleNumbers } from "../core/figure_data"
import { phrase, significant, WARNS, written } from "../core/words"

/** The motion across the path, or along it: what is said of it, and a line for each pole, as in app/view/poles.py. */
export interface Channel {
    line: string
    points: string[]
}

/** The poles of a channel [1/s], the slowest first, and how it behaves. */
export interface Motion {
    poles: Complex[]
    behaviour: "no_overshoot" | "no_oscillation" | "damping" | "unstable" | "swings" | "not_stable"
    /** until the motion has settled, or in which it grows [s]. */
    seconds: number
    damping: number
}

type Complex = readonly [number, number]
/** The coefficients of 1, w, w² … */
type Polynomial = readonly number[]

const LEAST_DECAY = 1e-3, NO_OSCILLATION = 0.995 // [1/s] and a damping ratio, as in models/control/poles.py
const STEPS = 100, NEAR = 1e-7 // most steps of the iteration to the roots, and how far they may move in its last one
const ROUNDING = 1e-12 // imaginary parts of z below this are rounding errors
const SETTLING = new Set(["no_overshoot", "no_oscillation", "damping"])

/** How the motions across and along the path behave with the gains K1 to K5. */
export function motions(numbers: PoleNumbers, gains: readonly number[]): [Motion, Motion] {
    const [k1, k2, k3, k4, k5] = gains as [number, number, number, number, number], { position } = numbers
    return [motion(numbers, [k1, k2, k3], k3 ? 3 : 2), motion(numbers, [k4, k5, 0], position ? 2 : 1)]
}

/** What is said of them. */
export function channels(data: FigureData, gains: readonly number[]): Channel[] {
    const [across, along] = motions(data.poles, gains)
    return [told(data, "across", across), told(data, "along", along)]
}

function told(data: FigureData, name: "across" | "along", { poles, behaviour, seconds, damping }: Motion): Channel {
    const values = { damping: written(data, damping, 2), seconds: significant(data, seconds, 2) }
    const kind = phrase(data, `behaviour.${behaviour}`, values), settles = SETTLING.has(behaviour)
    const says = settles ? phrase(data, "behaviour.settles", { ...values, kind }) : kind
    const shown = poles.map(pole => [pole[0], dampingOf(pole) >= NO_OSCILLATION ? 0 : pole[1]] as const).reverse() // the slowest last, as in the lab
    const list = shown.filter(([, imaginary]) => imaginary >= 0)
        .map(([real, imaginary]) => significant(data, real, 3) + (imaginary ? ` ± ${significant(data, imaginary, 3)}i` : ""))
    return {
        line: `${settles ? "" : WARNS}${phrase(data, `gains.${name}`)}: ${says}; ${phrase(data, "gains.poles", { poles: list.join(", ") })}`,
        points: shown.map(pole => `${name} ${pole.join(" ")}`),
    }
}

/** @param states of the channel that count: its velocity, its position, and its integral */
function motion({ interval, ahead, delay }: PoleNumbers, gains: readonly [number, number, number], states: 1 | 2 | 3): Motion {
    const polynomial = characteristic(interval, ahead, delay, gains, states)
    const poles = roots(polynomial).map(w => poleOf(w, interval)).sort(([a], [b]) => b - a)
    const stable = poles.every(([real]) => real < -LEAST_DECAY)
    const last = poles[states - 1]!, next = poles[states]
    const split = next && Math.abs(last[0] - next[0]) + Math.abs(last[1] + next[1]) <= 1e-6 * Math.abs(last[0]) && Math.abs(last[1]) > 1e-6 * Math.abs(last[0])
    const slow = poles.slice(0, split ? states + 1 : states) // with the conjugate of the last one
    const damping = Math.min(1, ...slow.map(dampingOf)), slowest = slow[0]![0]
    const swings = slow.some(([real, imaginary]) => real > -LEAST_DECAY && Math.abs(imaginary) > LEAST_DECAY)
    const calm = damping < NO_OSCILLATION ? "damping" : states === 3 ? "no_oscillation" : "no_overshoot"
    const lasting = slowest > LEAST_DECAY ? "unstable" : swings ? "swings" : "not_stable"
    return { poles: slow, behaviour: stable ? calm : lasting, seconds: stable ? -4 / slowest : 1 / slowest, damping }
}

/**
 * The characteristic polynomial of a channel. With l + f the delay, F = f + (1 - f) z and G = f (1 - f/2) + (1 - f)²/2 z, see
 * `_sampled` in models/control/poles.py:
 *
 *     w³ z^(l+1) + (k1 w + k3 t) X + k2 w² V = 0,
 *     X = t² F + t² w G + h t w F + h²/2 w²,   V = t F + h w,
 *
 * divided by w without an integral, and by w² without position, too.
 */
function characteristic(t: number, h: number, delay: number, [first, second, third]: readonly [number, number, number], states: 1 | 2 | 3): Polynomial {
    const whole = Math.floor(delay), f = delay - whole
    const early = [1, 1 - f], late = [f * (1 - f / 2) + (1 - f) ** 2 / 2, (1 - f) ** 2 / 2]
    const x = sum(times([t ** 2], early), times([0, t ** 2], late), times([0, h * t], early), [0, 0, h ** 2 / 2])
    const v = sum(times([t], early), [0, h])
    const delayed = Array.from({ length: whole + 1 }, (): Polynomial => [1, 1]).reduce(times)
    const zeros = (count: number): number[] => Array<number>(count).fill(0)
    const position = states === 1 ? [] : times(states === 3 ? [third * t, first] : [first], x)
    return sum(times([...zeros(states), 1], delayed), position, times([...zeros(states - 1), second], v))
}

function times(a: Polynomial, b: Polynomial): Polynomial {
    const found = Array<number>(a.length + b.length - 1).fill(0)
    a.forEach((x, i) => b.forEach((y, j) => (found[i + j]! += x * y)))
    return found
}

const sum = (...each: Polynomial[]): Polynomial =>
    Array.from({ length: Math.max(...each.map(p => p.length)) }, (_, i) => each.reduce((total, p) => total + (p[i] ?? 0), 0))

/** The roots of a polynomial whose leading coefficient is 1, by the method of Ehrlich and Aberth, until rounding moves them. */
function roots(polynomial: Polynomial): Complex[] {
    const size = polynomial.length - 1, angle = (i: number): number => (2 * Math.PI * (i + 0.3)) / size
    let found = Array.from({ length: size }, (_, i): Complex => [-0.5 + Math.cos(angle(i)), Math.sin(angle(i))])
    for (let step = 0, before = Infinity; step < STEPS; step++) {
        const next = found.map((w, i) => better(found, w, i, polynomial))
        const moved = Math.max(...next.map((w, i) => Math.hypot(...minus(w, found[i]!))))
        found = next
        if (moved < NEAR && moved >= before) break
        before = moved
    }
    return found
}

/** w - 1 / (p'/p - Σ 1 / (w - w_j)) = w - p / (p' - p Σ ...). */
function better(found: readonly Complex[], w: Complex, i: number, polynomial: Polynomial): Complex {
    let value: Complex = [0, 0], slope: Complex = [0, 0], away: Complex = [0, 0]
    for (const coefficient of polynomial.toReversed()) {
        slope = plus(product(slope, w), value)
        value = plus(product(value, w), [coefficient, 0])
    }
    found.forEach((other, j) => { if (j !== i) away = plus(away, quotient([1, 0], minus(w, other))) })
    return minus(w, quotient(value, minus(slope, product(value, away))))
}

/** ln(1 + w) / T, [1/s]. */
function poleOf([real, imaginary]: Complex, interval: number): Complex {
    const y = Math.abs(imaginary) < ROUNDING ? 0 : imaginary
    return [Math.log((1 + real) ** 2 + y ** 2 + 1e-300) / 2 / interval, Math.atan2(y, 1 + real) / interval]
}

const dampingOf = ([real, imaginary]: Complex): number => -real / Math.max(Math.hypot(real, imaginary), 1e-300)
const plus = (a: Complex, b: Complex): Complex => [a[0] + b[0], a[1] + b[1]]
const minus = (a: Complex, b: Complex): Complex => [a[0] - b[0], a[1] - b[1]]
const product = (a: Complex, b: Complex): Complex => [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]

/** a / b, and 0 for b = 0. */
function quotient(a: Complex, b: Complex): Complex {
    const squared = Math.max(b[0] ** 2 + b[1] ** 2, 1e-300), [x, y] = product(a, [b[0], -b[1]])
    return [x / squared, y / squared]
}
