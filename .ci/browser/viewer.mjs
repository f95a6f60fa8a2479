// Opens the page of the viewer in headless Chromium, at each built-in scene, and saves what it shows. A warning, an error,
// an exception or words of failure on the page are a failure.
//
//     node viewer.mjs FOLDER_OF_THE_PAGE FOLDER_OF_PICTURES [SCENE...]

import { mkdir } from 'node:fs/promises';
import { join } from 'node:path';
import { withPage } from './chromium.mjs';
import { serving } from './serving.mjs';

const [folder, pictures, ...wanted] = process.argv.slice(2);
const scenes = wanted.length ? wanted : ['textbook', 'town', 'hall', 'penumbrae', 'sky'];

await mkdir(pictures, { recursive: true });
const failures = await withPage(async (page, problems) => {
  await page.setViewportSize({ width: 1400, height: 800 });
  for (const scene of scenes) {
    // A page of the same path but another fragment would not be loaded again.
    await page.goto('about:blank');
    await page.goto(`${page.base}#scene=${scene}`);
    // The address holds all settings once a frame is drawn.
    const told = await Promise.race([
      page.waitForFunction(() => location.hash.includes('right.map'), null, { timeout: 120000 }).then(() => ''),
      page.waitForSelector('#failure:not([hidden])', { timeout: 120000 }).then((element) => element.textContent()),
    ]);
    if (told) problems.push(`the page says: ${told}`);
    await page.waitForTimeout(3000);
    await page.screenshot({ path: join(pictures, `${scene}.png`) });
    console.log(`${scene}: ${await page.evaluate(() => location.hash)}`);
  }
  return problems;
}, serving(folder));

for (const failure of failures) console.error(failure);
console.log(`${scenes.length} scenes, ${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
