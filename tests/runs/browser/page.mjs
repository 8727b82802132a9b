// page.mjs CHROMIUM PAGE: opens a report in a headless Chromium, uses it as a reader would with keys only, at the
// width of a desk and of a phone, and prints what it saw as one JSON object.
import {existsSync, statSync} from 'node:fs';
import {pathToFileURL} from 'node:url';

const packages = new URL('node_modules/playwright-core/package.json', import.meta.url);

export const canMeasure = () => existsSync(packages);

// What a reader can reach, in the page's order; drawn or not.
const controls = () => {
  const shown = e => e.getClientRects().length > 0 && !e.closest('dialog:not([open])');
  const list = 'a[href], button, input, select, textarea, summary, [tabindex="0"]';
  return [...document.querySelectorAll(list)].filter(shown).length;
};
const range = () => globalThis.report.grids().map(g => g.range ? [g.range.min, g.range.max] : null);

// Tab until the focus is back where it began: how many controls had it.
async function tabbed(page, most) {
  await page.evaluate(() => { globalThis.reached = new Set(); document.activeElement?.blur(); });
  for (let i = 0; i < most; ++i) {
    await page.keyboard.press('Tab');
    await page.evaluate(() => {
      const e = document.activeElement;
      if (e && e !== document.body) globalThis.reached.add(e);
    });
  }
  return page.evaluate(() => globalThis.reached.size);
}

// Plots are drawn when they come near: how many are, with each in view once.
async function drawn(page) {
  return page.evaluate(async () => {
    document.documentElement.style.scrollBehavior = 'auto';
    const frame = () => new Promise(done => requestAnimationFrame(done));
    const places = [...document.querySelectorAll('[data-plot]')];
    for (const place of places) {
      place.scrollIntoView({block: 'center'});
      for (let k = 0; k < 60 && !place.querySelector('canvas'); ++k) await frame();
    }
    scrollTo(0, 0);
    return document.querySelectorAll('[data-plot] canvas, .static svg').length;
  });
}

async function keys(page) {
  const out = {};
  if (!await page.evaluate(() => globalThis.report.interactive)) return {plots: false};
  const press = async key => { await page.keyboard.press(key); return (await page.evaluate(range))[0]; };
  const span = r => r[1] - r[0];
  await press('0');
  const closer = await press('+');
  const closest = await press('+');
  const later = await press('ArrowRight');
  const earlier = await press('ArrowLeft');
  const wider = await press('-');
  const whole = await press('0');
  out.zoom = Boolean(closer && closest && wider && span(closest) < span(closer) && span(wider) > span(closest)) &&
      whole === null;
  out.pan = later[0] > closest[0] && Math.abs(earlier[0] - closest[0]) < 1e-6;
  await page.keyboard.press('?');
  out.help = await page.evaluate(() => document.getElementById('help').open);
  await page.keyboard.press('Escape');
  out.help = out.help && !await page.evaluate(() => document.getElementById('help').open);
  const list = await page.$('.moments');
  if (list) {  // the first row by keys: its time is in view in every plot of the run
    await list.focus();
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('Enter');
    out.list = await page.evaluate(() => {
      const time = Number(document.querySelector('.moments tr.chosen').dataset.t);
      const range = globalThis.report.grids()[0].range;
      return Boolean(range) && range.min <= time && time <= range.max && range.max - range.min < 2;
    });
  }
  await press('0');
  return out;
}

export async function measure(executablePath, file, {screenshots = ''} = {}) {
  const {chromium} = await import('playwright-core');
  const browser = await chromium.launch({executablePath, args: ['--no-sandbox']});
  const seen = {bytes: statSync(file).size, requests: [], errors: []};
  const open = async viewport => {
    const phone = viewport.width < 600;
    const page = await browser.newPage({viewport, isMobile: phone, hasTouch: phone});
    page.on('console', m => { if (m.type() === 'error' || m.type() === 'warning') seen.errors.push(m.text()); });
    page.on('pageerror', e => seen.errors.push(String(e.message)));
    const url = pathToFileURL(file).href;
    page.on('request', r => { if (r.url() !== url && !/^(data|blob):/.test(r.url())) seen.requests.push(r.url()); });
    const start = performance.now();
    await page.goto(url);  // until the load event
    await page.evaluate(() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done))));
    return {page, ms: performance.now() - start};
  };
  try {
    const loads = [];
    for (let i = 0; i < 3; ++i) {
      const {page, ms} = await open({width: 1280, height: 900});
      loads.push(ms);
      await page.close();
    }
    seen.load_ms = loads.sort((a, b) => a - b)[1];
    const {page} = await open({width: 1280, height: 900});
    seen.charts = await page.evaluate(() => document.querySelectorAll('[data-plot], .static').length);
    seen.controls = await page.evaluate(controls);
    seen.reached = await tabbed(page, seen.controls + 3);
    seen.drawn = await drawn(page);
    seen.keys = await keys(page);
    if (screenshots) await page.screenshot({path: screenshots + '-desk.png'});
    const phone = (await open({width: 390, height: 844})).page;
    seen.phone_overflow = await phone.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    if (screenshots) await phone.screenshot({path: screenshots + '-phone.png'});
  } finally {
    await browser.close();
  }
  return seen;
}

// What is wrong with a page, in words; empty: nothing.
export function complaints(seen) {
  const wrong = [];
  if (seen.requests.length) wrong.push(`asks for ${seen.requests[0]}`);
  if (seen.errors.length) wrong.push(`says on the console: ${seen.errors[0]}`);
  if (seen.reached < seen.controls) wrong.push(`Tab reaches ${seen.reached} of ${seen.controls} controls`);
  if (seen.charts === 0 || seen.drawn < seen.charts) wrong.push(`${seen.drawn} of ${seen.charts} plots drawn`);
  for (const [what, works] of Object.entries(seen.keys)) if (!works) wrong.push(`keys: ${what} does not work`);
  if (seen.phone_overflow > 0) wrong.push(`${seen.phone_overflow} px too wide for a phone`);
  return wrong;
}

if (process.argv[1]?.endsWith('page.mjs')) {
  if (!canMeasure()) {
    console.log('skipped: npm could not fetch the packages of tests/runs/browser/package.json');
  } else {
    const seen = await measure(process.argv[2], process.argv[3], {screenshots: process.argv[4]});
    console.log(JSON.stringify({...seen, complaints: complaints(seen)}));
  }
}
