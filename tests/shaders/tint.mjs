// Has Tint, the WGSL compiler of Chrome, judge every file of a folder: `node tint.mjs FOLDER`. Needs the package `webgpu`, which
// NODE_PATH may lead to. Exits with 1 if any is refused, with 2 if the package is not there.
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

let dawn;
try {
    dawn = await import(pathToFileURL(createRequire(import.meta.url).resolve("webgpu")));
} catch (error) {
    console.error(`the package \`webgpu\` is not installed (npm install webgpu, then set NODE_PATH): ${error.message}`);
    process.exit(2);
}
// Nothing is run: no adapter is needed.
const gpu = dawn.create(["backend=null"]);
const adapter = await gpu.requestAdapter();
const features = ["subgroups"].filter((feature) => adapter.features.has(feature));
const device = await adapter.requestDevice({ requiredFeatures: features });

const folder = process.argv[2];
const names = readdirSync(folder).filter((name) => name.endsWith(".wgsl"));
let refused = 0;
for (const name of names) {
    device.pushErrorScope("validation");
    const module = device.createShaderModule({ code: readFileSync(join(folder, name), "utf8") });
    const { messages } = await module.getCompilationInfo();
    await device.popErrorScope();
    const errors = messages.filter((message) => message.type === "error");
    if (errors.length > 0) {
        refused += 1;
        console.log(`${name}:${errors[0].lineNum}: ${errors[0].message}`);
    }
}
console.log(`${refused} of ${names.length} refused`);
process.exit(refused > 0 ? 1 : 0);
