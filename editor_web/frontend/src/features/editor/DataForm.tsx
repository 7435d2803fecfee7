/** Where a state reads its inputs from, and under which userdata keys its outputs are written. */
import { Code } from '@mantine/core'
import { lookup, without } from '../../document/dict'
import type { KeyView } from '../../api/types'
import type { EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { performOn } from './apply'
import { inputLabel, outputLabel } from './dataFlow'
import { FormLine } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { useNames } from './useNames'

export function DataForm({ node, inputs, outputs }: { node: EditNode; inputs: readonly KeyView[]; outputs: readonly KeyView[] }) {
  const keys = useNames().map((name) => name.name)
  const ins = [...new Set([...inputs.map((key) => key.name), ...Object.keys(node.inputs)])]
  const outs = [...new Set([...outputs.map((key) => key.name), ...Object.keys(node.outputs)])]
  if (ins.length + outs.length === 0) return null
  const set = (field: 'in' | 'out', key: string, to: string) =>
    void performOn(node.path, `${field === 'in' ? 'Input' : 'Output'} ${key} of ${node.name}`, (now) => {
      const present = field === 'in' ? now.inputs : now.outputs
      const next = to ? { ...present, [key]: to } : without(present, key)
      return [setField(node.path, field, Object.keys(next).length > 0 ? next : null)]
    })
  return (
    <Section title="Userdata">
      {ins.map((key) => (
        <FormLine
          key={`in ${key}`}
          label={
            <>
              <Code bg="none" p={0}>
                {key}
              </Code>{' '}
              from
            </>
          }
        >
          <TemplateInput
            label={inputLabel(key)}
            placeholder={inputs.find((each) => each.name === key)?.required ? key : 'its default'}
            options={keys}
            value={lookup(node.inputs, key) ?? ''}
            onCommit={(typed) => set('in', key, typed)}
          />
        </FormLine>
      ))}
      {outs.map((key) => (
        <FormLine
          key={`out ${key}`}
          label={
            <>
              <Code bg="none" p={0}>
                {key}
              </Code>{' '}
              to
            </>
          }
        >
          <TemplateInput
            label={outputLabel(key)}
            placeholder="nowhere"
            options={keys}
            value={lookup(node.outputs, key) ?? ''}
            onCommit={(typed) => set('out', key, typed)}
          />
        </FormLine>
      ))}
    </Section>
  )
}
