// SPDX-License-Identifier: MIT
// Gives out a folder on 127.0.0.1: node serve.mjs FOLDER [PORT], or serve() from tests.
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };

/** Returns the address and what ends it. */
export function serve(folder, port = 0) {
    const server = createServer(async (request, response) => {
        try {
            const path = normalize(decodeURIComponent(new URL(request.url, "http://127.0.0.1").pathname));
            const file = path.endsWith("/") ? `${path}index.html` : path;
            response.setHeader("Cross-Origin-Opener-Policy", "same-origin"); // so pages are isolated, and have shared memory
            response.setHeader("Cross-Origin-Embedder-Policy", "require-corp");
            response.setHeader("Content-Type", TYPES[extname(file)] ?? "application/octet-stream");
            response.end(await readFile(join(folder, file)));
        } catch {
            response.writeHead(404).end("there is no such file\n");
        }
    });
    return new Promise((resolve, reject) => {
        server.on("error", reject);
        server.listen(port, "127.0.0.1", () => resolve({ address: `http://127.0.0.1:${server.address().port}/`, end: () => server.close() }));
    });
}

if (process.argv[1] && import.meta.url === pathToFileURL(process.argv[1]).href) {
    const { address } = await serve(process.argv[2], Number(process.argv[3] ?? 8048)).catch(() => serve(process.argv[2]));
    console.log(`the page is at ${address}`);
}
