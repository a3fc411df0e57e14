// The functions of the WebAssembly module, and the memory on which they work.

import type { Point } from "../core/figure_data"
import { mathematics } from "./mathematics"

type Exported = (...addresses: number[]) => void

const DOUBLE = 8 // bytes
const PAGES = 128 // of 64 KiB

/** A vector is given by the index of its first double in `numbers`. */
export class Kernels {
    readonly numbers = new Float64Array(this.memory.buffer)
    private end = 0

    private constructor(
        private readonly exported: Record<string, Exported>,
        private readonly memory: WebAssembly.Memory,
    ) {}

    /** From a module, compressed by gzip, in base64. */
    static async from(text: string): Promise<Kernels> {
        const packed = new Blob([Uint8Array.from(atob(text), letter => letter.charCodeAt(0))])
        const bytes = await new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer()
        const memory = new WebAssembly.Memory({ initial: PAGES })
        const { instance } = await WebAssembly.instantiate(bytes, {
            Math: { memory, ...mathematics },
        })
        return new Kernels(instance.exports as unknown as Record<string, Exported>, memory)
    }

    /** Allocate a vector of a number of doubles. */
    room(count: number): number {
        const address = this.end
        this.end += count
        if (this.end > this.numbers.length) throw new Error("the page's memory is full")
        return address
    }

    /** Allocate a vector with its values. */
    put(values: ArrayLike<number>): number {
        const address = this.room(values.length)
        this.numbers.set(values, address)
        return address
    }

    readonly pair = (address: number): Point => [this.numbers[address]!, this.numbers[address + 1]!]
    readonly copy = (from: number, to: number, count: number) => this.numbers.copyWithin(to, from, from + count)

    /** Call a function on vectors. */
    call(name: string, ...addresses: number[]): void {
        this.function(name)(...addresses.map(address => DOUBLE * address))
    }

    /** Call a loop or a scan: see `wasm_of` in models/closed_loop/wasm_loop.py. */
    loop(name: string, vectors: [number, number, number, number], ticks: number): void {
        this.function(name)(...vectors.map(address => DOUBLE * address), ticks)
    }

    private function(name: string): Exported {
        const found = this.exported[name]
        if (!found) throw new Error(`the module has no ${name}`)
        return found
    }
}
