// SPDX-License-Identifier: MIT
// Threads: workers that share the module's memory, each with an instance and a stack of its own. A batch is divided into parts of
// whole blocks of 64 pairs; rows of the parts behind each other are those of one thread.
import type { Memory } from "./memory.js";

/** What workers can be asked for. */
export const PARTS: readonly string[] = ["narc_find_contacts", "narc_find_manifolds", "narc_find_overlaps", "narc_find_separations"];
/** Words of a job: its number, that of the last one done, what is called, with how many arguments, what it returned. */
export const JOB = { asked: 0, done: 1, part: 2, count: 3, status: 4, args: 8, size: 32 };
const STACK = 1 << 17, BLOCK = 64, LEAST = 16 * BLOCK;

export interface Job {
    module: WebAssembly.Module;
    memory: WebAssembly.Memory;
    stack: number;
    place: number;
}
interface Thread {
    postMessage(job: Job): void;
    terminate(): unknown;
    unref?(): void;
    once?(name: "message" | "error", run: (told: unknown) => void): void;
    onmessage?: unknown;
    onerror?: unknown;
}

export interface Range { first: number; count: number }

export class Threads {
    readonly #memory: Memory;
    readonly #threads: Thread[] = [];
    readonly #places: number[] = [];
    #number = 0;
    #waits = true;

    private constructor(memory: Memory) {
        this.#memory = memory;
    }

    static async start(memory: Memory, module: WebAssembly.Module, shared: WebAssembly.Memory, count: number): Promise<Threads> {
        const threads = new Threads(memory), node = "node:worker_threads", beside = "./worker.js";
        const page = typeof Worker === "function", Node = page ? undefined : (await import(/* webpackIgnore: true */ /* @vite-ignore */ node) as { Worker: new (url: URL) => Thread }).Worker;
        const ready: Promise<unknown>[] = [];
        for (let k = 0; k < count; k++) {
            // Bundlers know the first one as it stands.
            const thread = page ? new Worker(new URL("./worker.js", import.meta.url), { type: "module" }) as unknown as Thread
                : new Node!(new URL(beside, import.meta.url));
            const place = memory.allocate(4 * JOB.size), stack = memory.allocate(STACK + 16) + STACK & ~15;
            threads.#threads.push(thread);
            threads.#places.push(place);
            ready.push(new Promise((done, fail) => {
                const failed = (told: unknown): void => fail(new Error(`a worker does not start: ${(told as Error).message}`));
                if (thread.once) {
                    thread.once("message", done);
                    thread.once("error", failed);
                } else {
                    thread.onmessage = done;
                    thread.onerror = failed;
                }
            }));
            thread.postMessage({ module, memory: shared, stack, place });
        }
        await Promise.all(ready);
        for (const thread of threads.#threads)
            thread.unref?.();
        return threads;
    }

    /** Parts of a batch, the first of which is the caller's; one part where more are not worth it. */
    divide(count: number): Range[] {
        const parts = Math.max(1, Math.min(this.#threads.length + 1, Math.floor(count / LEAST))), size = Math.ceil(count / parts / BLOCK) * BLOCK;
        return Array.from({ length: parts }, (_, k) => ({ first: k * size, count: Math.min(size, count - k * size) })).filter((part) => part.count > 0);
    }

    /** Calls a function for each list of arguments, all at once; returns what they returned. */
    run(name: string, lists: readonly number[][]): number[] {
        const words = new Int32Array(this.#memory.u8.buffer), part = PARTS.indexOf(name), others = lists.slice(1);
        this.#number = this.#number + 1 | 0;
        others.forEach((args, k) => {
            const at = this.#places[k]! >> 2;
            words.set(args, at + JOB.args);
            words[at + JOB.part] = part;
            words[at + JOB.count] = args.length;
            Atomics.store(words, at + JOB.asked, this.#number);
            Atomics.notify(words, at + JOB.asked);
        });
        const first = this.#memory.function(name)(...lists[0]!);
        return [first, ...others.map((_, k) => {
            const at = this.#places[k]! >> 2;
            for (let seen = Atomics.load(words, at + JOB.done); seen !== this.#number; seen = Atomics.load(words, at + JOB.done))
                this.#wait(words, at + JOB.done, seen);
            return words[at + JOB.status]!;
        })];
    }

    /** A page's own thread may not sleep: it asks again and again, for the microseconds by which parts differ. */
    #wait(words: Int32Array, at: number, seen: number): void {
        if (this.#waits)
            try {
                Atomics.wait(words, at, seen);
            } catch {
                this.#waits = false;
            }
    }

    /** Ends the workers; what comes is done by the caller's thread. */
    end(): void {
        for (const thread of this.#threads)
            thread.terminate();
        this.#threads.length = this.#places.length = 0;
    }
}
