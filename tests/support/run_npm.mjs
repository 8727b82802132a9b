// run_npm.mjs SCRIPT BINARY SOURCE_DIR: a script beside this one, if npm could fetch what package.json asks for.
import {existsSync, readFileSync} from 'node:fs';

const beside = (name) => new URL(name, import.meta.url);
const {dependencies} = JSON.parse(readFileSync(beside('package.json'), 'utf8'));
const missing = Object.keys(dependencies).filter((name) => !existsSync(beside(`node_modules/${name}/package.json`)));
const [script] = process.argv.splice(2, 1);
if (missing.length === 0) {
  await import(`./${script}`);
} else {
  console.log(`skipped: npm could not fetch ${missing.join(', ')}`);
}
