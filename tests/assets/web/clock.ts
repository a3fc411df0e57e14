// Time for tests: it passes only when a test lets it.

import { mock } from "node:test"

mock.timers.enable({ apis: ["setTimeout"] })
let now = 1000
Object.defineProperty(performance, "now", { value: () => now })

export function pass(milliseconds: number): void {
    for (let left = milliseconds; left > 0; ) {
        const part = Math.min(left, 1)
        now += part
        left -= part
        mock.timers.tick(part)
    }
}

export const time = (): number => now
