// Shared by the tests of what editors get: running the program, reading YAML, counting failures.
import {execFileSync} from 'node:child_process';
import {readFileSync, readdirSync, existsSync} from 'node:fs';
import path from 'node:path';
import {parse} from 'yaml';

export const [binary, source] = process.argv.slice(2, 4).map((p) => path.resolve(p));

export function schema(kind) {
  return JSON.parse(execFileSync(binary, ['schema', kind], {encoding: 'utf8', maxBuffer: 1 << 26}));
}

export function readYaml(file) {
  return parse(readFileSync(file, 'utf8'), {version: '1.2', merge: false});
}

function yamlBelow(folder) {
  if (!existsSync(folder)) return [];
  return readdirSync(folder, {recursive: true}).filter((f) => f.endsWith('.yaml'))
      .map((f) => path.join(folder, f)).sort();
}

// The kind of a file is its first key, or that of the file it inherits.
export function kindOf(file) {
  const text = readYaml(file);
  if (text === null || typeof text !== 'object') return undefined;
  for (const kind of ['behavior', 'robot', 'world', 'scenario']) {
    if (Object.keys(text)[0] === kind) return kind;
  }
  return text.base === undefined ? undefined : kindOf(path.resolve(path.dirname(file), text.base));
}

// Every file that is shipped, with its kind.
export function shipped() {
  const files = ['behaviors/library', 'examples', 'robots', 'sim/worlds']
      .flatMap((folder) => yamlBelow(path.join(source, folder)));
  files.push(path.join(source, 'tests/unit/behaviors/load/kim2016_printed.yaml'));
  return files.map((file) => ({file, kind: kindOf(file), name: path.relative(source, file)}))
      .filter(({kind}) => kind !== undefined);
}

let failures = 0;
let checks = 0;
export function expect(good, text) {
  ++checks;
  if (good) return;
  ++failures;
  console.error('FAILED: ' + text);
}
export function finish(figure) {
  console.log(`${figure}; ${checks - failures} of ${checks} checks hold`);
  process.exit(failures === 0 ? 0 : 1);
}
