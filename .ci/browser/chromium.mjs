// Opens headless Chromium with WebGPU and WebGL 2 in software, at a page of this machine.

import http from 'node:http';
import { chromium } from 'playwright-core';

const FLAGS = [
  '--enable-unsafe-webgpu',
  '--use-webgpu-adapter=swiftshader',
  '--enable-features=Vulkan',
  // Without this one, what WebGPU draws to a canvas is not shown.
  '--use-vulkan=swiftshader',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
];

// Chromium refuses its sandbox to root, which containers run as.
const OF_ROOT = process.getuid() === 0 ? ['--no-sandbox'] : [];

function answerEmpty(_, response) {
  response.setHeader('content-type', 'text/html');
  response.end('<!doctype html><link rel="icon" href="data:,"><title>checks</title>');
}

// Calls `body(page, problems)` at `page.base`, which `answer(request, response)` serves. `problems` collects what the page
// says: warnings, errors and exceptions. Without `flags` Chromium is started as it comes.
export async function withPage(body, answer = answerEmpty, { flags = FLAGS } = {}) {
  // WebGPU is there only for pages of a secure context, which those of the local machine are.
  const server = http.createServer(answer);
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
  const browser = await chromium.launch({ executablePath, headless: true, args: [...flags, ...OF_ROOT] });
  try {
    const page = await browser.newPage();
    const problems = [];
    page.on('console', (message) => {
      if (['warning', 'error'].includes(message.type())) problems.push(`console: ${message.text()}`);
    });
    page.on('pageerror', (error) => problems.push(`exception: ${error}`));
    page.on('crash', () => problems.push('the page crashed'));
    page.base = `http://127.0.0.1:${server.address().port}/`;
    if (answer === answerEmpty) await page.goto(page.base);
    console.log(`Chromium ${browser.version()}`);
    return await body(page, problems);
  } finally {
    await browser.close();
    server.close();
  }
}
