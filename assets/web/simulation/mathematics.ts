// The functions that a module imports as "Math": MATHEMATICS in models/closed_loop/operations.py, as C has them.

const { sin, cos, tan, asin, acos, atan, exp, log, expm1, log1p } = Math
const { sinh, cosh, tanh, asinh, acosh, atanh, atan2, hypot } = Math

/** 1 to any power is 1 in C, and so is -1 to an infinite one. */
const pow = (x: number, y: number) =>
    x === 1 || (x === -1 && Math.abs(y) === Infinity) ? 1 : Math.pow(x, y)

const fmod = (x: number, y: number) => x % y

/** x - n y with the integer n nearest to x / y, or the even one of two equally near. Doubling is exact. */
const remainder = (x: number, y: number) => {
    const size = Math.abs(y)
    let rest = Math.abs(x) % (2 * size)
    if (2 * rest > size) {
        rest -= size
        if (2 * rest >= size) rest -= size
    }
    return x < 0 || Object.is(x, -0) ? -rest : rest
}

export const mathematics = {
    sin, cos, tan, asin, acos, atan, exp, log, expm1, log1p,
    sinh, cosh, tanh, asinh, acosh, atanh, atan2, hypot, pow, fmod, remainder,
}
