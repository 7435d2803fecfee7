/** The settings that only some kinds have: items and rounds, memory, policies, periods. */
import { lookup } from '../../document/dict'
import { Switch } from '@mantine/core'
import type { EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { looseValue, shownValue } from '../../document/editing/fields'
import { perform } from './apply'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'

interface Setting {
  readonly key: string
  readonly words: string
  readonly hint: string
  readonly kind?: 'switch' | 'text'
}

const SETTINGS: Record<string, readonly Setting[]> = {
  concurrency: [
    { key: 'shared', words: 'Shared keys', hint: 'Names as a list: branches see each other write them' },
  ],
  foreach: [
    { key: 'items', words: 'Items', hint: 'A list, or ${…} that gives one' },
    { key: 'times', words: 'Times', hint: 'Rounds, instead of items' },
    { key: 'as', words: 'Item is called', hint: 'Key of the item in each round, `item` without' },
    { key: 'index', words: 'Number is called', hint: 'Key of the number of the round' },
  ],
  sequence: [{ key: 'memory', words: 'Memory', hint: 'A child that is done is not asked again', kind: 'switch' }],
  selector: [{ key: 'memory', words: 'Memory', hint: 'A child that is done is not asked again', kind: 'switch' }],
  parallel: [
    { key: 'policy', words: 'Succeeds with', hint: '`all`, `one`, or names of children as a list' },
    { key: 'synchronise', words: 'Synchronise', hint: 'What has succeeded waits for the others', kind: 'switch' },
    { key: 'success_count', words: 'Successes', hint: 'So many must succeed, instead of a policy' },
    { key: 'failure_count', words: 'Failures', hint: 'So many must fail, 1 without' },
  ],
  repeat: [{ key: 'times', words: 'Times', hint: 'Successes in a row' }],
  retry: [
    { key: 'times', words: 'Times', hint: 'How often it is run again after failure' },
    { key: 'backoff', words: 'Wait first', hint: 'Such as 2 s' },
  ],
  timeout: [{ key: 'after', words: 'After', hint: 'Such as 30 s' }],
  cooldown: [{ key: 'after', words: 'After', hint: 'Such as 30 s' }],
  guard: [
    { key: 'when', words: 'While', hint: 'An expression, ${…}' },
    { key: 'to', words: 'Else', hint: 'failure, success or skipped; failure without' },
  ],
  one_shot: [{ key: 'policy', words: 'Once', hint: '`completion` or `success`' }],
}

export function SettingsForm({ node }: { node: EditNode }) {
  const settings = SETTINGS[node.kind] ?? []
  if (settings.length === 0) return null
  const set = (setting: Setting, value: unknown) =>
    void perform(`${setting.words} of ${node.name}`, [setField(node.path, setting.key, value)])
  return (
    <Section title="Settings">
      {settings.map((setting) => (
        <div key={setting.key} className="edit-line">
          <span title={setting.hint}>{setting.words}</span>
          {setting.kind === 'switch' ? (
            <Switch
              size="sm"
              aria-label={setting.words}
              checked={lookup(node.settings, setting.key) !== false}
              onChange={(event) => set(setting, event.currentTarget.checked)}
            />
          ) : (
            <TemplateInput
              label={setting.words}
              placeholder={setting.hint}
              value={shownValue(lookup(node.settings, setting.key))}
              onCommit={(typed) => set(setting, typed === '' ? null : looseValue(typed))}
            />
          )}
        </div>
      ))}
    </Section>
  )
}
