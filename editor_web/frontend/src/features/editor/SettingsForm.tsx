/** The settings that only some kinds have: items and rounds, memory, policies, periods. */
import { lookup } from '../../document/dict'
import { Switch } from '@mantine/core'
import { IconGridDots } from '@tabler/icons-react'
import type { KindField } from '../../api/types'
import { askWizard } from '../../api/valueWizard'
import type { EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { looseValue, shownValue } from '../../document/editing/fields'
import { perform } from './apply'
import { FormLine } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'
import { useEditor } from './store'

export function SettingsForm({ node }: { node: EditNode }) {
  const catalogue = useEditor((s) => s.catalogue)
  const settings = catalogue?.containers.find((each) => each.kind === node.kind)?.form ?? []
  if (settings.length === 0) return null
  const set = (setting: KindField, value: unknown) =>
    void perform(`${setting.label} of ${node.name}`, [setField(node.path, setting.key, value)])
  return (
    <Section title="Settings">
      {settings.map((setting) => (
        <FormLine key={setting.key} label={setting.label} title={setting.hint}>
          {setting.control === 'switch' ? (
            <Switch
              size="sm"
              aria-label={setting.label}
              checked={lookup(node.settings, setting.key) !== false}
              onChange={(event) => set(setting, event.currentTarget.checked)}
            />
          ) : (
            <TemplateInput
              label={setting.label}
              placeholder={setting.hint}
              value={shownValue(lookup(node.settings, setting.key))}
              onCommit={(typed) => set(setting, typed === '' ? null : looseValue(typed))}
            />
          )}
          {setting.control === 'list' && (
            <Tool
              isSmall
              label={`Teach ${setting.label} as a grid of poses`}
              onPress={() =>
                askWizard({
                  kind: 'grid',
                  title: `${setting.label.toLowerCase()} of ${node.name}`,
                  arm: '',
                  value: lookup(node.settings, setting.key),
                  onSet: (value) => set(setting, value),
                })
              }
            >
              <IconGridDots size={13} aria-hidden />
            </Tool>
          )}
        </FormLine>
      ))}
    </Section>
  )
}
