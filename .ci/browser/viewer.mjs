// Opens the page of the viewer in headless Chromium, at each built-in scene, and saves what it shows. A warning, an error,
// an exception or words of failure on the page are a failure.
//
//     node viewer.mjs FOLDER_OF_THE_PAGE FOLDER_OF_PICTURES [SCENE...]

import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { withPage } from './chromium.mjs';
import { openViewer, settled } from './opening.mjs';
import { serving } from './serving.mjs';

const [folder, pictures, ...wanted] = process.argv.slice(2);
const scenes = wanted.length ? wanted : ['textbook', 'town', 'hall', 'penumbrae', 'sky', 'grove'];

await mkdir(pictures, { recursive: true });
const failures = await withPage(async (page, problems) => {
  await page.setViewportSize({ width: 1400, height: 800 });
  for (const scene of scenes) {
    const told = await openViewer(page, `scene=${scene}`);
    if (told) problems.push(`the page says: ${told}`);
    await settled(page, { path: join(pictures, `${scene}.png`) });
    console.log(`${scene}: ${await page.evaluate(() => location.hash)}`);
  }
  return problems;
}, serving(folder));

for (const failure of failures) console.error(failure);
console.log(`${scenes.length} scenes, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
