// report_test.mjs BINARY SOURCE_DIR CHROMIUM: the report of a run, and of two runs beside each other, in a browser.
import {execFileSync} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import {complaints, measure} from './page.mjs';

const [binary, source, chromium] = process.argv.slice(2);
const folder = mkdtempSync(path.join(tmpdir(), 'footfall-report-'));
const footfall = (...args) => execFileSync(binary, args, {cwd: source, stdio: ['ignore', 'ignore', 'inherit']});
const log = name => path.join(folder, name);
let failures = 0;
try {
  footfall('run', 'tests/runs/regression/live_edits.yaml', '--log', log('a'), '--no-report', '--quiet');
  footfall('run', 'balance_best', '--for', '6s', '--seed', '2', '--push', '20,0.1,90,4s', '--log', log('b'),
           '--no-report', '--quiet');
  const pages = {one: [log('a')], two: [log('a'), log('b')]};
  for (const [name, logs] of Object.entries(pages)) {
    const page = path.join(folder, name + '.html');
    footfall('report', ...logs, '-o', page);
    const seen = await measure(chromium, page);
    for (const text of complaints(seen)) {
      console.error(`report of ${name}: ${text}`);
      ++failures;
    }
    console.log(`report of ${name}: ${(seen.bytes / 1e6).toFixed(1)} MB, ${seen.load_ms.toFixed(0)} ms, ` +
                `${seen.charts} plots, ${seen.reached} of ${seen.controls} controls by Tab`);
  }
} finally {
  rmSync(folder, {recursive: true, force: true});
}
process.exit(failures ? 1 : 0);
