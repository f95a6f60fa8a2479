// Opens the page of the viewer.

// Opens the page with these settings, and waits until a frame is drawn or the page tells a failure, which it returns.
export async function openViewer(page, address) {
  // A page of the same path but another fragment would not be loaded again.
  await page.goto('about:blank');
  await page.goto(`${page.base}#${address}`);
  // The address holds all settings once a frame is drawn.
  return Promise.race([
    page.waitForFunction(() => location.hash.includes('right.map'), null, { timeout: 120000 }).then(() => ''),
    failure(page),
  ]);
}

// Waits until the page tells a failure, and returns it.
export async function failure(page) {
  const element = await page.waitForSelector('#failure:not([hidden])', { timeout: 120000 });
  return element.textContent();
}

// Takes pictures until one is like that before, and returns it.
export async function settled(page, options = {}) {
  let last = null;
  for (let tries = 0; tries < 60; tries++) {
    await page.waitForTimeout(1000);
    const shot = await page.screenshot(options);
    if (last?.equals(shot)) return shot;
    last = shot;
  }
  throw new Error('the page goes on to change');
}
