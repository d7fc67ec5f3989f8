// SPDX-License-Identifier: MIT
// What Chromium shows of pictures and what three.js reads of them, for readers.py: answers its jobs, [how, path] each.
import * as THREE from "three";

const bytes = async (path) => (await fetch(`/${path}`)).arrayBuffer();

// As a page shows it: through a canvas of sRGB.
async function shown(path) {
    const image = new Image();
    image.src = `/${path}`;
    await image.decode();
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    return { codes: true, width: image.width, channels: 4, data: Array.from(context.getImageData(0, 0, image.width, image.height).data) };
}

// What a loader of three.js gives, turned so that the upper row is the first.
async function loaded(path, loader, isDown) {
    loader.setDataType?.(THREE.FloatType);
    const { data, width, height } = loader.parse(await bytes(path));
    const channels = data.length / width / height, out = [];
    for (let y = 0; y < height; ++y) {
        const row = isDown ? height - 1 - y : y;
        out.push(...data.slice(row * width * channels, (row + 1) * width * channels));
    }
    return { codes: data instanceof Uint8Array || data instanceof Uint8ClampedArray, width, channels, data: out };
}

const readers = {
    shown,
    exr: async (path) => loaded(path, new (await import("three/addons/loaders/EXRLoader.js")).EXRLoader(), true),
    hdr: async (path) => loaded(path, new (await import("three/addons/loaders/HDRLoader.js")).HDRLoader(), false),
    tif: async (path) => loaded(path, new (await import("three/addons/loaders/TIFFLoader.js")).TIFFLoader(), false),
    ultra_hdr: async (path) => loaded(path, new (await import("three/addons/loaders/UltraHDRLoader.js")).UltraHDRLoader(), true),
    cube: async (path) => {
        const { LUTCubeLoader } = await import("three/addons/loaders/LUTCubeLoader.js");
        const table = new LUTCubeLoader().setType(THREE.FloatType).parse(new TextDecoder().decode(await bytes(path)));
        const numbers = Array.from(table.texture3D.image.data);
        return { size: table.size, min: table.domainMin.toArray(), max: table.domainMax.toArray(), data: numbers };
    },
    gain_map: async (path) => {
        const { HDRJPGLoader } = await import("@monogrid/gainmap-js");
        const made = await new HDRJPGLoader(new THREE.WebGLRenderer()).loadAsync(`/${path}`);
        const { width, height } = made, data = Array.from(made.toArray(), THREE.DataUtils.fromHalfFloat), out = [];
        for (let y = height - 1; y >= 0; --y) out.push(...data.slice(y * width * 4, (y + 1) * width * 4));
        return { width, channels: 4, data: out };
    },
};

// What Chromium and three.js write of codes, or of light: the bytes of the file.
const writers = {
    canvas: async ([colorSpace, type, width, codes]) => {
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [width, codes.length / 4 / width];
        const context = canvas.getContext("2d", { colorSpace });
        context.putImageData(new ImageData(new Uint8ClampedArray(codes), width, canvas.height, { colorSpace }), 0, 0);
        const blob = await new Promise((done) => canvas.toBlob(done, type, 1));
        return Array.from(new Uint8Array(await blob.arrayBuffer()));
    },
    exporter: async ([bits, width, light]) => {
        const { EXRExporter } = await import("three/addons/exporters/EXRExporter.js");
        const texture = new THREE.DataTexture(new Float32Array(light), width, light.length / 4 / width, THREE.RGBAFormat, THREE.FloatType);
        const type = bits === "half" ? THREE.HalfFloatType : THREE.FloatType;
        return Array.from(await new EXRExporter().parse(texture, { type }));
    },
};

// Curves of engines by their own code: for each a fragment of GLSL that gives codes of `light`, and the engine's texts before it.
const playcanvas = "/node/playcanvas/build/playcanvas/src/scene/shader-lib/glsl/chunks/common/frag";
const babylon = "/node/@babylonjs/core/Shaders/ShadersInclude";
const engines = {
    "three.js": async (curve) => [
        THREE.ShaderChunk.tonemapping_pars_fragment + THREE.ShaderChunk.colorspace_pars_fragment,
        `sRGBTransferOETF(vec4(${curve}(light), 1.0)).rgb`,
    ],
    "Babylon.js": async (kind) => {
        const { helperFunctions } = await import(`${babylon}/helperFunctions.js`);
        const { imageProcessingFunctions } = await import(`${babylon}/imageProcessingFunctions.js`);
        return [`#define USE_EXACT_SRGB_CONVERSIONS 0\n#define TONEMAPPING ${kind}\n${helperFunctions.shader}${imageProcessingFunctions.shader}`,
            "applyImageProcessing(vec4(light, 1.0)).rgb"];
    },
    PlayCanvas: async (file) => {
        const text = async (name) => (await import(`${playcanvas}/${name}.js`)).default;
        const gamma = (await text("gamma")).replace('#include "decodePS"', await text("decode"));
        return [`#define SRGB 1\n#define GAMMA SRGB\nfloat getExposure() { return 1.0; }\n${gamma}${await text(`tonemapping/${file}`)}`,
            "gammaCorrectOutput(toneMap(light))"];
    },
};
writers.curve = async ([engine, name, lights]) => {
    const [texts, codes] = await engines[engine](name);
    const count = lights.length / 3, canvas = new OffscreenCanvas(count, 1), gl = canvas.getContext("webgl2");
    const program = gl.createProgram();
    for (const [type, source] of [
        [gl.VERTEX_SHADER, "void main() { gl_Position = vec4(vec2[](vec2(-1, -1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0, 1); }"],
        [gl.FRAGMENT_SHADER, `precision highp float;\n${texts}\nuniform vec3 lights[${count}];\nout vec4 color;
void main() { vec3 light = lights[int(gl_FragCoord.x)]; color = vec4(${codes}, 1.0); }`],
    ]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, `#version 300 es\n${source}`);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
        gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.uniform3fv(gl.getUniformLocation(program, "lights"), lights);
    gl.uniform1f(gl.getUniformLocation(program, "toneMappingExposure"), 1);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const pixels = new Uint8Array(count * 4);
    gl.readPixels(0, 0, count, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return Array.from(pixels);
};

const answers = [];
for (const [how, path] of await (await fetch("/jobs")).json())
    answers.push(await (readers[how] ?? writers[how])(path).catch((error) => String(error.message ?? error)));
await fetch("/", { method: "POST", body: JSON.stringify(answers) });
