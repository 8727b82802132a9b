// The JSON Schemas against every shipped file, with a validator that knows nothing of Footfall: all
// are accepted, each misspelt key is refused, so are values of the wrong kind.
import Ajv from 'ajv';
import {expect, finish, readYaml, schema, shipped} from './support.mjs';

const ajv = new Ajv({strict: false, allErrors: false});
const schemas = {};
const validators = {};
function validator(kind) {
  if (validators[kind] === undefined) {
    schemas[kind] = schema(kind);
    validators[kind] = ajv.compile(schemas[kind]);
  }
  return validators[kind];
}

// The schemas that speak of a value, through references and alternatives.
function candidates(kind, part, value) {
  if (part === undefined || typeof part === 'boolean') return [];
  const out = [part];
  if (part.$ref) {
    out.push(...candidates(kind, schemas[kind].definitions[part.$ref.split('/').pop()], value));
  }
  for (const other of part.anyOf ?? []) out.push(...candidates(kind, other, value));
  if (part.if) {
    const has = ({required}) => (required ?? []).every((k) => value?.[k] !== undefined);
    const holds = has(part.if) && (part.if.anyOf ?? [{}]).some(has);
    out.push(...candidates(kind, holds ? part.then : part.else, value));
  }
  return out;
}

// Calls visit(map, key) for every key with a fixed meaning.
function visitKeys(kind, part, value, visit) {
  const found = candidates(kind, part, value);
  if (Array.isArray(value)) {
    for (const item of value) {
      visitKeys(kind, {anyOf: found.map((s) => s.items).filter((s) => s)}, item, visit);
    }
  } else if (value !== null && typeof value === 'object') {
    const open = found.some((s) => typeof s.additionalProperties === 'object');
    for (const key of Object.keys(value)) {
      const own = found.map((s) => s.properties?.[key]).filter((s) => typeof s === 'object');
      const free = found.map((s) => s.additionalProperties).filter((s) => typeof s === 'object');
      visitKeys(kind, {anyOf: own.length > 0 ? own : free}, value[key], visit);
      if (own.length > 0 && !open) visit(value, key);
    }
  }
}

function rename(map, key, name) {
  const entries = Object.entries(map);
  for (const k of Object.keys(map)) delete map[k];
  for (const [k, v] of entries) map[k === key ? name : k] = v;
}

let keys = 0;
for (const {file, kind, name} of shipped()) {
  const validate = validator(kind);
  const document = readYaml(file);
  expect(validate(document), `${name} is refused: ${ajv.errorsText(validate.errors)}`);
  visitKeys(kind, schemas[kind], document, (map, key) => {
    if (key === 'base') return;
    ++keys;
    const wrong = key.slice(0, 1) + 'q' + key.slice(1);
    rename(map, key, wrong);
    expect(!validate(document), `${name}: the key '${wrong}' (for '${key}') is accepted`);
    rename(map, wrong, key);
  });
}

const state = (keysOfState) => ({behavior: 1, machine: {states: {a: keysOfState}}});
const refused = [
  state({after: '100 N', to: 'a'}),
  state({after: '10 ms', to: 3}),
  state({type: 'paralel'}),
  state({tasks: {height: {type: 'com_positon'}}}),
  state({tasks: {height: {priority: 'high'}}}),
  state({tasks: {height: {gains: {kp: '3 kg'}}}}),
  state({tasks: {damp: {type: 'joint_damping', reference: 0}}}),
  state({tasks: {height: {reference: {trajectory: 'hold', over: '1 s'}}}}),
  state({tasks: {height: {reference: {trajectory: 'cosine', overr: '1 s'}}}}),
  state({transitions: {on: 'go'}}),
  state({transitions: [{to: 'a'}]}),
  state({transitions: [{after: '1 s'}]}),
  state({on_entry: [{}]}),
  state({contact_transition: {releases: 'foot', over: '3 m'}}),
  {behavior: 1},
  {behavior: 2, machine: {}},
  {machine: {}},
  {behavior: 1, machine: {}, parameters: {a: {live: true}}},
  {behavior: 1, machine: {}, parameters: {a: {value: 1, live: 'yes'}}},
  {behavior: 1, machine: {}, planners: {foot: {kappa: 0.4}}},
];
const accepted = [
  state({after: '10 ms', to: 'a'}),
  state({after: 0.5, to: ['a', 'b']}),
  state({after: '$time', to: 'a'}),
  state({after: '= 2*$time', to: 'a'}),
  state(null),
  state({tasks: {height: 'off'}}),
  state({tasks: {height: {reference: '= entry + 3 cm'}}}),
  state({tasks: {height: {reference: {z: '3 cm'}}}}),
  state({tasks: {height: {reference: {trajectory: '$shape', over: '1 s'}}}}),
  state({tasks: {hold: {type: 'joint_posture', joints: ['*knee'], gains: {kp: {'*knee': '4 1/s^2'}}}}}),
  {base: 'other.yaml', parameters: {a: {live: false}}, machine: {'transitions+': [{on: 'go', to: 'a'}]}},
  {behavior: 1, machine: {states: {a: {transitions: [{on: 'go'}]}}}},
  {base: 'other.yaml', machine: {states: {a: {invoke: 'off', 'invoke+': []}}}},
  {behavior: 1, machine: {}, parameters: {a: '3 kg m^2/s^2', b: ['1 N', '2 kN'], c: {value: '440 Nm/rad'}}},
];
const validate = validator('behavior');
for (const text of refused) expect(!validate(text), `accepted: ${JSON.stringify(text)}`);
for (const text of accepted) {
  expect(validate(text), `refused: ${JSON.stringify(text)}: ${ajv.errorsText(validate.errors)}`);
}
finish(`${shipped().length} shipped files accepted, ${keys} misspelt keys refused`);
