// Compiles what `cargo run --example emitted_wgsl` wrote: every WGSL text by Chromium's WebGPU (Tint), and the GLSL that
// wgpu makes of it for WebGL 2 by Chromium's WebGL (ANGLE). An error or a warning is a failure.
//
//     node compile.mjs FOLDER

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { withPage } from './chromium.mjs';

const folder = process.argv[2];
const index = JSON.parse(await readFile(join(folder, 'index.json'), 'utf8'));
const read = (file) => readFile(join(folder, file), 'utf8');

// The functions below run in the page.

async function openWebGpu() {
  const adapter = await navigator.gpu?.requestAdapter();
  if (!adapter) throw new Error('no WebGPU adapter');
  const device = await adapter.requestDevice();
  globalThis.webgpu = device;
  device.addEventListener('uncapturederror', (event) => console.error(event.error.message));
  return `${adapter.info.vendor} ${adapter.info.architecture}`;
}

// Returns what Tint says of the text and, where it has entry points, of its pipeline.
async function compileWgsl({ code, vertex, fragment }) {
  const device = globalThis.webgpu;
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  const told = messages.map(({ type, lineNum, message }) => `${type} in line ${lineNum}: ${message}`);
  const error = await device.popErrorScope();
  if (error && !told.length) told.push(error.message);
  if (!vertex || told.length) return told;
  const attributes = [0, 1, 2, 3, 4].map((shaderLocation) => ({
    shaderLocation,
    offset: 16 * shaderLocation,
    format: 'float32x4',
  }));
  const writesDepth = !fragment || code.includes('@builtin(frag_depth)');
  const targets = writesDepth ? [] : [{ format: 'rgba8unorm' }];
  const depth = { format: 'depth32float', depthWriteEnabled: true, depthCompare: 'greater' };
  try {
    await device.createRenderPipelineAsync({
      layout: 'auto',
      vertex: { module, entryPoint: vertex, buffers: [{ arrayStride: 80, attributes }] },
      ...(fragment && { fragment: { module, entryPoint: fragment, targets } }),
      ...(writesDepth && { depthStencil: depth }),
    });
  } catch (refused) {
    told.push(`pipeline: ${refused.message}`);
  }
  return told;
}

function openWebGl() {
  const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
  if (!gl) throw new Error('no WebGL 2');
  globalThis.webgl = gl;
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
}

// Returns what ANGLE says of the shaders and of the program.
function compileGlsl([vertex, fragment]) {
  const gl = globalThis.webgl;
  const told = [];
  const program = gl.createProgram();
  const stages = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]];
  const shaders = stages.map(([stage, text]) => {
    const shader = gl.createShader(stage);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    const log = gl.getShaderInfoLog(shader)?.replaceAll('\0', '').trim();
    if (log || !gl.getShaderParameter(shader, gl.COMPILE_STATUS)) told.push(log || 'not compiled');
    gl.attachShader(program, shader);
    return shader;
  });
  if (!told.length) {
    gl.linkProgram(program);
    const log = gl.getProgramInfoLog(program)?.replaceAll('\0', '').trim();
    if (log || !gl.getProgramParameter(program, gl.LINK_STATUS)) told.push(log || 'not linked');
  }
  for (const shader of shaders) gl.deleteShader(shader);
  gl.deleteProgram(program);
  return told;
}

const failures = [];
let passed = 0;
const note = (name, host, told) => {
  if (told.length) failures.push(`${name} (${host}):\n${told.join('\n')}`);
  else passed += 1;
};

await withPage(async (page, problems) => {
  console.log(`WebGPU: ${await page.evaluate(openWebGpu)}`);
  let start = Date.now();
  // WebGPU has no pass of several views.
  const wanted = index.filter(({ multiview }) => !multiview);
  for (const { name, wgsl, vertex, fragment } of wanted) {
    const told = await page.evaluate(compileWgsl, { code: await read(wgsl), vertex, fragment });
    note(name, 'WebGPU', told);
  }
  console.log(`${wanted.length} WGSL texts in ${((Date.now() - start) / 1000).toFixed(1)} s`);

  console.log(`WebGL 2: ${await page.evaluate(openWebGl)}`);
  start = Date.now();
  const programs = wanted.filter(({ webgl2 }) => webgl2);
  for (const { name, webgl2 } of programs) {
    const texts = await Promise.all(webgl2.map(read));
    note(name, 'WebGL 2', await page.evaluate(compileGlsl, texts));
  }
  console.log(`${programs.length} GLSL programs in ${((Date.now() - start) / 1000).toFixed(1)} s`);
  failures.push(...problems);
});

for (const failure of failures.slice(0, 20)) console.error(failure);
console.log(`${passed} passed, ${failures.length} failed`);
process.exit(failures.length || !passed ? 1 : 0);
