// Which scenes the JSON Schema accepts: all that are shipped and those of right/, and none of wrong_scenes.yaml.
//   node check.mjs MODULES ROOT
import {readFileSync, readdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';

const [modules, root] = process.argv.slice(2);
const require = createRequire(resolve(modules, 'package.json'));
const Ajv = require('ajv');
const YAML = require('yaml');

const schema = JSON.parse(readFileSync(join(root, 'scenes/patchlight.schema.json'), 'utf8'));
const validate = new Ajv({allErrors: true, strict: true, strictTypes: false, strictRequired: false}).compile(schema);

let failures = 0;
const fail = text => {
  ++failures;
  console.error(text);
};

const scenes = folder =>
  readdirSync(join(root, folder)).filter(name => name.endsWith('.yaml')).map(name => join(root, folder, name));
const right = [...scenes('scenes'), ...scenes('scenes/parts'), ...scenes('tests/schema/right')];
for (const path of right) {
  if (validate(YAML.parse(readFileSync(path, 'utf8')))) continue;
  fail(`${path} is refused: ${validate.errors.map(error => `${error.instancePath} ${error.message}`).join('; ')}`);
}

const wrong = YAML.parseAllDocuments(readFileSync(join(root, 'tests/schema/wrong_scenes.yaml'), 'utf8'));
for (const document of wrong)
  if (validate(document.toJS())) fail(`accepted, but wrong:${document.commentBefore ?? document.contents.commentBefore}`);

if (right.length < 24 || wrong.length < 40) fail(`only ${right.length} right and ${wrong.length} wrong scenes were found`);
console.log(`${right.length} scenes to accept, ${wrong.length} to refuse, ${failures} failures`);
process.exit(failures > 0 ? 1 : 0);
