// log_test.mjs BINARY: a run's log read by the public MCAP reader through its index and schemas; blocks decoded by
// docs/log.md; every value against `footfall export`.
import {McapIndexedReader} from '@mcap/core';
import {decompress} from 'fzstd';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import path from 'node:path';
import protobuf from 'protobufjs';
import descriptor from 'protobufjs/ext/descriptor/index.js';

import {ColumnDecoder, real, single, singleBits} from './columns.mjs';

const binary = path.resolve(process.argv[2]);
const folder = mkdtempSync(path.join(tmpdir(), 'footfall-log-'));
let wrong = 0;
const expect = (truth, text) => {
  if (!truth && ++wrong < 20) console.log(`FAILED: ${text}`);
};
const footfall = (...args) => execFileSync(binary, args, {encoding: 'utf8', maxBuffer: 1 << 28});

try {
  footfall('run', 'balance_best', '--for', '1s', '--seed', '3', '--goal', '0.1,0', '--no-report', '--quiet', '--log', folder);
  const data = new Uint8Array(readFileSync(path.join(folder, 'log.mcap')));
  const reader = await McapIndexedReader.Initialize({
    readable: {size: async () => BigInt(data.length), read: async (at, size) => data.slice(Number(at), Number(at + size))},
    decompressHandlers: {zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size)))},
  });

  const metadata = {};
  for await (const record of reader.readMetadata()) metadata[record.name] = record.metadata;
  expect(metadata.run.get('behavior') === 'balance_best', 'metadata: behavior');
  const files = [];
  for await (const file of reader.readAttachments()) files.push(file.name);
  for (const name of ['balance_best.yaml', 'robot.yaml', 'hume.xml']) {
    expect(files.some((file) => file.endsWith(name)), `attachment ${name}`);
  }

  const types = {};
  for (const [id, schema] of reader.schemasById) {
    const root = protobuf.Root.fromDescriptor(descriptor.FileDescriptorSet.decode(schema.data));
    types[id] = root.lookupType(schema.name);
  }
  const messages = {};
  for await (const message of reader.readMessages({validateCrcs: true})) {
    const channel = reader.channelsById.get(message.channelId);
    const decoded = types[channel.schemaId].decode(message.data);
    (messages[channel.topic] ??= []).push({sequence: message.sequence, ...types[channel.schemaId].toObject(decoded, {defaults: true, longs: Number})});
  }
  // Blocks go on from the one before in the file; the reader gives them by time.
  for (const list of Object.values(messages)) list.sort((a, b) => a.sequence - b.sequence);

  const names = JSON.parse(metadata.columns.get('columns'));
  const signals = JSON.parse(metadata.signals.get('signals'));
  const period = 1000 / Number(metadata.setup.get('rate_mhz'));
  const inputs = new Map();
  const decoder = new ColumnDecoder(64, names.length, 0, period);
  for (const block of messages['/inputs']) {
    expect(block.digest.length === block.ticks, 'a digest for each tick');
    const rows = decoder.decode(block.columns, block.ticks, block.continues);
    rows.forEach((row, k) => inputs.set(block.first_tick + k, row));
  }
  expect(inputs.size === 1501, `inputs of ${inputs.size} ticks`);
  const time = names.indexOf('time_ns'), height = names.indexOf('p_WB.z');
  expect(inputs.get(900)[time] === 600000000n, 'the clock of tick 900');
  expect(Math.abs(real(inputs.get(900)[height]) - 0.9) < 0.2, 'the base is at its height');

  const rows = new Map();
  const floats = new ColumnDecoder(32, names.length + signals.length, names.length, period);
  for (const block of messages['/signals']) {
    const ticks = block.offset.map((offset) => block.first_tick + offset);
    const known = ticks.map((tick) => inputs.get(tick).map((word) => singleBits(real(word))));
    floats.decode(block.columns, ticks.length, block.continues, known).forEach((row, k) => {
      expect(!rows.has(ticks[k]), `tick ${ticks[k]} comes twice`);
      rows.set(ticks[k], row.slice(names.length).map(single));
    });
  }
  const [head, ...lines] = footfall('export', folder, '--csv', '--all').trim().split('\n');
  // `tick`, then the signals by their names, the state by its path.
  const [, ...exported] = head.split(',');
  const states = JSON.parse(metadata.run.get('states'));
  expect(new Set(exported).size === signals.length, 'each signal is a column of the CSV, once');
  const places = exported.map((name) => signals.findIndex((signal) => signal.name === name));
  expect(!places.includes(-1), 'columns of the CSV are named as the signals');
  expect(lines.length === rows.size && rows.size > 250, `${lines.length} lines, ${rows.size} rows`);
  for (const line of lines) {
    const [tick, ...cells] = line.split(',');
    cells.forEach((cell, k) => {
      const value = rows.get(Number(tick))?.[places[k]];
      const same = exported[k] === 'state' ? states[value] === cell
        : exported[k] === 'time' ? Math.abs(Number(cell) - value) < 1e-6
        : cell === '' ? Number.isNaN(value) : Math.fround(Number(cell)) === value;
      expect(same, `tick ${tick} ${exported[k]}: ${cell} exported, ${value} here`);
    });
  }

  const plans = new ColumnDecoder(64, 12, 0, 0);
  let planned = 0;
  for (const block of messages['/plans'] ?? []) {
    for (const row of plans.decode(block.columns, block.rows, block.continues)) {
      planned += row[3] === 1n && Math.abs(real(row[4])) < 2 ? 1 : 0;
    }
  }
  expect(planned > 0, 'plans');
  expect(messages['/parameters'][0].name.includes('gains.single.height.kp'), 'names of parameters');
  expect(messages['/edits'].length > 0, 'the goal was edited');
  const events = footfall('export', folder, '--csv', '--events').trim().split('\n').length - 1;
  expect(messages['/events'].length === events && events > 0, `${events} events`);
} finally {
  rmSync(folder, {recursive: true});
}
console.log(wrong === 0 ? 'the public reader agrees' : `${wrong} differences`);
process.exitCode = wrong === 0 ? 0 : 1;
