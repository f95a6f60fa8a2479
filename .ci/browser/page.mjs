// Uses the page of the viewer in headless Chromium: files that are dropped on it, the clipboard, a caster whose WGSL is
// broken, and browsers without WebGPU.
//
//     node page.mjs FOLDER_OF_THE_PAGE FOLDER_OF_PICTURES

import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { withPage } from './chromium.mjs';
import { failure, openViewer, settled } from './opening.mjs';
import { serving } from './serving.mjs';

const [folder, pictures] = process.argv.slice(2);
const failures = [];
let checks = 0;

function check(holds, words) {
  checks += 1;
  console.log(`${holds ? 'right' : 'WRONG'}: ${words}`);
  if (!holds) failures.push(words);
}

// Returns a binary glTF file of one triangle.
function triangle() {
  const positions = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, count: 3, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 0] }],
    bufferViews: [{ buffer: 0, byteLength: positions.length }],
    buffers: [{ byteLength: positions.length }],
  };
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, ' ')]);
  const words = (...numbers) => Buffer.from(new Uint32Array(numbers).buffer);
  const [GLTF, JSON_CHUNK, BINARY_CHUNK] = [0x46546c67, 0x4e4f534a, 0x004e4942];
  const chunks = [words(padded.length, JSON_CHUNK), padded, words(positions.length, BINARY_CHUNK), positions];
  const length = 12 + chunks.reduce((sum, chunk) => sum + chunk.length, 0);
  return Buffer.concat([words(GLTF, 2, length), ...chunks]);
}

async function drop(page, name, bytes) {
  const transfer = await page.evaluateHandle(([name, base64]) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const transfer = new DataTransfer();
    transfer.items.add(new File([bytes], name));
    return transfer;
  }, [name, bytes.toString('base64')]);
  await page.dispatchEvent('#viewer', 'drop', { dataTransfer: transfer });
}

async function files(page, problems) {
  check((await openViewer(page, 'scene=textbook')) === '', 'the page opens');
  await settled(page);
  await drop(page, 'triangle.glb', triangle());
  // The address names built-in scenes alone.
  const isOther = () => !location.hash.includes('scene=textbook');
  const opened = await page.waitForFunction(isOther, null, { timeout: 20000 }).then(() => true, () => false);
  check(opened, 'a dropped file is shown');
  const before = await settled(page, { path: join(pictures, 'dropped.png') });
  await drop(page, 'broken.glb', Buffer.from('no glTF'));
  const after = await settled(page, { path: join(pictures, 'broken-file.png') });
  check(!after.equals(before), 'a file that cannot be read is told on the page');
  check(!problems.length, `neither writes a warning or an error: ${problems}`);
}

async function clipboard(page) {
  await page.context().grantPermissions(['clipboard-read', 'clipboard-write'], { origin: page.base });
  await openViewer(page, 'scene=textbook');
  await settled(page);
  await page.keyboard.press('c');
  await page.waitForTimeout(1000);
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  check(copied.includes('DirectionalShadowDescriptor {'), `the descriptor is copied: ${JSON.stringify(copied)}`);
}

// Breaks the WGSL of the leaves' cards behind the viewer's back.
function breakCaster() {
  const create = GPUDevice.prototype.createShaderModule;
  GPUDevice.prototype.createShaderModule = function (descriptor) {
    const isCaster = descriptor.code.includes('card_fragment');
    const code = isCaster ? `${descriptor.code}\nconst BROKEN: f32 = shadow_of_nothing;\n` : descriptor.code;
    return create.call(this, { ...descriptor, code });
  };
}

async function brokenCaster(page) {
  const told = [];
  page.on('console', (message) => told.push(`${message.type()}: ${message.text()}`));
  await page.addInitScript(breakCaster);
  check((await openViewer(page, 'scene=textbook')) === '', 'the page goes on beside a caster with broken WGSL');
  await settled(page, { path: join(pictures, 'broken-caster.png') });
  // The viewer writes what comes to `on_uncaptured_error` as an error, and Chromium its own words as warnings.
  const arrived = told.filter((text) => text.startsWith('error:') && text.includes('shadow_of_nothing'));
  check(arrived.length > 0, `the text of the error arrives at on_uncaptured_error: ${arrived[0] ?? told.join('\n')}`);
}

// Is Chromium as it comes, which has no adapter for WebGPU where there is no GPU.
async function withoutAdapter(page) {
  await page.goto(page.base);
  const words = await failure(page);
  check(words.includes('Chrome'), `a browser without an adapter is told what works: ${words}`);
  await page.screenshot({ path: join(pictures, 'without-adapter.png') });
}

async function withoutWebGpu(page) {
  await page.addInitScript(() => delete Navigator.prototype.gpu);
  await page.goto(page.base);
  const words = await failure(page);
  check(words.includes('needs WebGPU') && words.includes('Chrome'), `so is one without WebGPU: ${words}`);
  await page.screenshot({ path: join(pictures, 'without-webgpu.png') });
}

await mkdir(pictures, { recursive: true });
const page = serving(folder);
await withPage(files, page);
await withPage(clipboard, page);
await withPage(brokenCaster, page);
await withPage(withoutAdapter, page, { flags: [] });
await withPage(withoutWebGpu, page);
console.log(`${checks} checks, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
