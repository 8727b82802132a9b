// run.mjs BINARY: log_test.mjs, if npm could fetch what it needs.
import {existsSync} from 'node:fs';

const folder = new URL('.', import.meta.url);
if (['@mcap/core', 'fzstd', 'protobufjs'].every((name) => existsSync(new URL(`node_modules/${name}/package.json`, folder)))) {
  await import('./log_test.mjs');
} else {
  console.log('skipped: npm could not fetch the packages of tests/runs/log/package.json');
}
