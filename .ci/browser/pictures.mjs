// Compares what the viewer draws in headless Chromium with what it draws on this machine's own driver, for lights, filters,
// biases, layouts, debug views, casters that discard, and rays. At most one pixel in fifty may differ by more than 8 of 255, and only at an
// edge of either picture: rasterisers decide otherwise about the pixels along it. A warning, an error or an exception of the page is a failure.
//
//     node pictures.mjs FOLDER_OF_THE_PAGE FOLDER_OF_PICTURES VIEWER [NAME...]

import { execFileSync } from 'node:child_process';
import { mkdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { withPage } from './chromium.mjs';
import { openViewer, settled } from './opening.mjs';
import { serving } from './serving.mjs';

const [folder, pictures, viewer, ...wanted] = process.argv.slice(2);

// Is the size of the window, and of the picture between its panels, above the line that names the adapter.
const SIZE = { width: 1064, height: 360 };
const PANEL = 292;
const CLIP = { x: PANEL, y: 0, width: SIZE.width - 2 * PANEL, height: SIZE.height - 32 };

// Is the largest difference of a channel that does not count, and the largest share of pixels that may differ by more.
const TOLERANCE = 8;
const SHARE = 0.02;
// Is how far from an edge of the picture, in pixels, a difference still lies at it.
const REACH = 2;

const CASES = {
  textbook_and_default: 'scene=textbook',
  nearest_and_hardware: 'scene=textbook&left.filter=nearest&right.filter=hardware',
  box_and_bilinear: 'scene=textbook&left.filter=box&right.filter=bilinear,2',
  tents: 'scene=textbook&left.filter=tent5,4&right.filter=tent7,5',
  biases: 'scene=textbook&left.bias=normal_offset&right.bias=manual,0.02,0.2',
  sixteen_bits: 'scene=textbook&left.scene=0&left.half=1&right.half=1&right.filter=nearest',
  visibility: 'scene=textbook&show=visibility',
  map: 'scene=textbook&show=map,0&split=0',
  penumbrae: 'scene=penumbrae',
  penumbrae_rotated: 'scene=penumbrae&left.filter=pcss_rotated&right.filter=pcss_rotated&right.found=0&right.cascades=1',
  town_found_and_fixed: 'scene=town&left.scene=0&left.map=2048&left.found=0&left.cascades=3&left.filter=tent3,3&left.bias=auto',
  town_cascades: 'scene=town&show=cascades&split=0',
  town_blended: 'scene=town&right.blend=0.2&right.found=0&right.end=120&right.fade=0.3&split=0',
  town_map: 'scene=town&show=map,0&split=0',
  town_sphere: 'scene=town&right.found=0&right.end=150&right.still=1&split=0',
  hall: 'scene=hall',
  hall_directions: 'scene=hall&right.lamp_filter=star,0.04',
  hall_soft: 'scene=hall&right.lamp_filter=pcss&left.lamp_filter=hardware',
  hall_visibility: 'scene=hall&show=visibility&split=0',
  hall_lamp: 'scene=hall&show=lamp,3&split=0',
  hall_spot: 'scene=hall&show=spot,1&split=0',
  sky: 'scene=sky&split=0',
  leaves: 'scene=grove',
  leaves_map: 'scene=grove&show=map,0&split=0',
  leaves_sixteen_bits: 'scene=grove&right.half=1&right.filter=hardware&split=0',
  rays: 'scene=textbook&show=difference',
};

// Are those that rays are cast for before.
const TRUTHS = new Set(['rays']);

// Runs in the page: counts the pixels in which two PNG files differ, and those of them that are at no edge of either.
async function compare([expected, seen, tolerance, reach]) {
  const pixels = async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height);
  };
  const [a, b] = [await pixels(expected), await pixels(seen)];
  if (a.width !== b.width || a.height !== b.height) return { all: 0, differ: 1, away: 1 };
  const apart = (x, i, y, j) => Math.max(...[0, 1, 2].map((channel) => Math.abs(x.data[i + channel] - y.data[j + channel])));
  const at = (x, y) => 4 * (y * a.width + x);
  const isEdge = (image, x, y) => {
    for (let v = Math.max(y - reach, 0); v <= Math.min(y + reach, a.height - 1); v++) {
      for (let u = Math.max(x - reach, 0); u <= Math.min(x + reach, a.width - 1); u++) {
        if (apart(image, at(x, y), image, at(u, v)) > tolerance) return true;
      }
    }
    return false;
  };
  let [differ, away] = [0, 0];
  for (let y = 0; y < a.height; y++) {
    for (let x = 0; x < a.width; x++) {
      if (apart(a, at(x, y), b, at(x, y)) <= tolerance) continue;
      differ += 1;
      if (!isEdge(a, x, y) && !isEdge(b, x, y)) away += 1;
    }
  }
  return { all: a.width * a.height, differ, away };
}

await mkdir(pictures, { recursive: true });
const names = Object.keys(CASES).filter((name) => !wanted.length || wanted.includes(name));
const failures = await withPage(async (page, problems) => {
  await page.setViewportSize(SIZE);
  for (const name of names) {
    const address = `${CASES[name]}&scale=1`;
    const [whole, expected, seen] = ['window', 'expected', 'browser'].map((kind) => join(pictures, `${name}.${kind}.png`));
    const size = [SIZE.width, SIZE.height].map(String);
    const truth = TRUTHS.has(name) ? ['--truth'] : [];
    execFileSync(viewer, ['--screenshot', whole, '--size', ...size, '--address', address, ...truth], { stdio: 'inherit' });

    const told = await openViewer(page, address);
    if (told) problems.push(`${name}: the page says: ${told}`);
    if (TRUTHS.has(name)) await page.keyboard.press('t');
    await settled(page);
    await page.screenshot({ path: seen, clip: CLIP });
    await page.goto('about:blank');
    await page.setContent(`<img src="data:image/png;base64,${await readFile(whole, 'base64')}">`);
    await page.addStyleTag({ content: 'body { margin: 0 } img { display: block }' });
    await page.screenshot({ path: expected, clip: CLIP });
    const files = await Promise.all([expected, seen].map((path) => readFile(path, 'base64')));
    const { all, differ, away } = await page.evaluate(compare, [...files, TOLERANCE, REACH]);
    console.log(`${name}: ${differ} of ${all} pixels differ, ${away} of them away from edges`);
    if (differ > SHARE * all || away > 0) problems.push(`${name}: ${differ} of ${all} pixels differ, ${away} away from edges`);
  }
  return problems;
}, serving(folder));

for (const failure of failures) console.error(failure);
console.log(`${names.length} pictures, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
