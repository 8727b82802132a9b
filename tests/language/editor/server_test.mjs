// What an author sees: a real YAML language server with the schema, spoken to over stdio as editors
// do. Keys are offered where they may stand, with their meaning; a wrong key has a diagnostic.
import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import {createRequire} from 'node:module';
import {pathToFileURL} from 'node:url';
import {expect, finish, schema} from './support.mjs';

const require = createRequire(import.meta.url);
const rpc = require('vscode-jsonrpc/node');

const folder = mkdtempSync(path.join(os.tmpdir(), 'footfall-editor-'));
const schemaFile = path.join(folder, 'behavior.schema.json');
writeFileSync(schemaFile, JSON.stringify(schema('behavior')));

const server = spawn(process.execPath,
    [path.join(path.dirname(require.resolve('yaml-language-server/package.json')),
        'bin/yaml-language-server'), '--stdio'], {stdio: ['pipe', 'pipe', 'inherit']});
const connection = rpc.createMessageConnection(
    new rpc.StreamMessageReader(server.stdout), new rpc.StreamMessageWriter(server.stdin));
const settings = {
  yaml: {
    schemas: {[pathToFileURL(schemaFile).href]: ['*.yaml']},
    schemaStore: {enable: false}, validate: true, completion: true, hover: true,
  },
};
connection.onRequest('workspace/configuration',
    ({items}) => items.map(({section}) => settings[section] ?? {}));
connection.onRequest('client/registerCapability', () => null);
const waiting = new Map();
connection.onNotification('textDocument/publishDiagnostics', ({uri, diagnostics}) => {
  waiting.get(uri)?.(diagnostics);
});
connection.listen();
setTimeout(() => {
  console.error('FAILED: the language server did not answer in 100 s');
  process.exit(1);
}, 100000).unref();

await connection.sendRequest('initialize', {
  processId: process.pid, rootUri: pathToFileURL(folder).href, workspaceFolders: null,
  capabilities: {
    textDocument: {
      completion: {completionItem: {documentationFormat: ['markdown'], snippetSupport: true}},
      hover: {contentFormat: ['markdown']},
      publishDiagnostics: {},
    },
    workspace: {configuration: true, didChangeConfiguration: {}},
  },
});
await connection.sendNotification('initialized', {});
await connection.sendNotification('workspace/didChangeConfiguration', {settings});

let count = 0;
// Opens a text; `|` marks the cursor. Resolves to the document, the cursor and the diagnostics.
async function open(marked, ending = 'yaml') {
  const at = marked.indexOf('|');
  const text = at < 0 ? marked : marked.slice(0, at) + marked.slice(at + 1);
  const before = at < 0 ? '' : marked.slice(0, at);
  const position = {line: before.split('\n').length - 1, character: before.length - 1 - before.lastIndexOf('\n')};
  const uri = pathToFileURL(path.join(folder, `test${++count}.${ending}`)).href;
  const reported = new Promise((resolve) => waiting.set(uri, resolve));
  await connection.sendNotification('textDocument/didOpen',
      {textDocument: {uri, languageId: 'yaml', version: 1, text}});
  return {textDocument: {uri}, position, diagnostics: await reported};
}
async function complete(marked) {
  const {textDocument, position} = await open(marked);
  const answer = await connection.sendRequest('textDocument/completion', {textDocument, position});
  return Array.isArray(answer) ? answer : answer.items;
}
const documentation = (item) =>
  typeof item?.documentation === 'string' ? item.documentation : item?.documentation?.value ?? '';

function offers(items, where, names) {
  for (const [name, doc] of Object.entries(names)) {
    const item = items.find(({label}) => label === name);
    expect(item !== undefined, `'${name}' is not offered ${where}: ${items.map((i) => i.label)}`);
    expect(documentation(item).includes(doc), `'${name}' ${where} says '${documentation(item)}'`);
  }
}

const head = 'behavior: 1\nrobot: hume\nmachine:\n  states:\n    stand:\n';
offers(await complete('behavior: 1\n|'), 'in a file',
    {machine: 'root state', stacks: 'named sets', parameters: '$NAME'});
const inState = await complete(head + '      stack: dual\n      |');
offers(inState, 'in a state', {
  after: 'this long after entry', transitions: 'transitions from it', contacts: 'constrained contacts',
  contact_transition: 'torque-continuous', on_entry: 'actions',
});
expect(!inState.some(({label}) => label === 'priority'), 'a key of tasks is offered in a state');
offers(await complete(head + '      tasks:\n        height:\n          type: com_position\n          |'),
    'in a task', {priority: 'null space', reference: 'desired value', gains: 'gain'});
offers(await complete(head + '      tasks:\n        height:\n          type: |'),
    'as a type', {com_position: '', joint_posture: ''});
offers(await complete(head + '      tasks:\n        height:\n          reference:\n            |'),
    'in a reference', {trajectory: 'shape'});
offers(await complete(head +
    '      tasks:\n        height:\n          reference:\n            trajectory: cosine\n            |'),
    'in a trajectory', {over: 'duration', to: 'end value'});
offers(await complete(head + '      transitions:\n        - on: go\n          |'),
    'in a transition', {to: 'target', when: 'condition', do: 'actions'});
offers(await complete('base: other.yaml\nmachine:\n  |'), 'in a file with a base', {safe: 'fault'});

const hovered = await open(head + '      aft|er: 10 ms\n      to: stand\n');
const hover = await connection.sendRequest('textDocument/hover', hovered);
const shown = JSON.stringify(hover?.contents ?? '');
expect(shown.includes('this long after entry') && shown.includes('time'), `hover says ${shown}`);

async function diagnosed(text, line, ...words) {
  const {diagnostics} = await open(text);
  const found = diagnostics.filter((d) => d.range.start.line === line);
  expect(found.some((d) => words.every((word) => d.message.includes(word))),
      `line ${line} of ${JSON.stringify(text)}: ${JSON.stringify(diagnostics.map((d) => [d.range.start.line, d.message]))}`);
}
await diagnosed(head + '      aftr: 10 ms\n', 5, 'aftr');
await diagnosed(head + '      after: 100 N\n      to: stand\n', 5, 'time');
await diagnosed(head + '      type: paralel\n', 5, 'parallel');
await diagnosed(head + '      tasks: {height: {type: com_positon}}\n', 5, 'com_position');
await diagnosed(head + '      tasks: {height: {type: com_position, priorty: 1}}\n', 5, 'priorty');
await diagnosed(head + '      tasks: {height: {reference: {trajectory: cosine, overr: 1 s}}}\n', 5, 'overr');
const clean = await open(head + '      tasks: {height: {type: com_position, reference: 0.9 m}}\n      after: $long\n      to: stand\n');
expect(clean.diagnostics.length === 0, `a good file has ${JSON.stringify(clean.diagnostics)}`);
// The settings above speak of *.yaml only: here the file itself names its schema.
const modeline = await open('# yaml-language-server: $schema=behavior.schema.json\n' + head + '      aftr: 1 s\n', 'yml');
expect(modeline.diagnostics.some((d) => d.message.includes('aftr')), 'a modeline has no effect');

server.kill();
rmSync(folder, {recursive: true, force: true});
finish(`yaml-language-server ${require('yaml-language-server/package.json').version} completes, shows and diagnoses`);
