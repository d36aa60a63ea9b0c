// SPDX-License-Identifier: MIT
// A worker of load({ threads }): it shares the module's memory, and takes parts of batches until it is ended.
import { type Job, JOB, PARTS } from "./threads.js";

async function work({ module, memory, stack, place }: Job, ready: () => void): Promise<void> {
    const { exports } = await WebAssembly.instantiate(module, { env: { memory } });
    (exports["__stack_pointer"] as WebAssembly.Global).value = stack; // one of its own; _initialize() was called once for all
    const words = new Int32Array(memory.buffer), parts = PARTS.map((name) => exports[name] as (...args: number[]) => number), at = place >> 2;
    ready();
    for (let seen = 0;;) {
        Atomics.wait(words, at + JOB.asked, seen);
        seen = Atomics.load(words, at + JOB.asked);
        const count = words[at + JOB.count]!, args = words.subarray(at + JOB.args, at + JOB.args + count);
        words[at + JOB.status] = parts[words[at + JOB.part]!]!(...args);
        Atomics.store(words, at + JOB.done, seen);
        Atomics.notify(words, at + JOB.done);
    }
}

interface Port {
    once(name: "message", run: (job: Job) => void): void;
    postMessage(message: string): void;
}

if (typeof postMessage === "function")
    onmessage = (event: { data: Job }) => void work(event.data, () => postMessage("ready"));
else {
    const node = "node:worker_threads";
    void import(/* webpackIgnore: true */ /* @vite-ignore */ node).then(({ parentPort }: { parentPort: Port }) =>
        parentPort.once("message", (job) => void work(job, () => parentPort.postMessage("ready"))));
}
