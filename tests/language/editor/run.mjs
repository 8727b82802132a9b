// run.mjs BINARY SOURCE_DIR NAME: the test NAME_test.mjs, if npm could fetch what it needs.
import {existsSync} from 'node:fs';

const folder = new URL('.', import.meta.url);
if (existsSync(new URL('node_modules/ajv/package.json', folder)) &&
    existsSync(new URL('node_modules/yaml-language-server/package.json', folder))) {
  await import(`./${process.argv[4]}_test.mjs`);
} else {
  console.log('skipped: npm could not fetch the packages of tests/language/editor/package.json');
}
