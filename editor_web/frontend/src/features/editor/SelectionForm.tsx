/** The form of several nodes: what all of them have, set in all of them by one edit. */
import { Button, Textarea } from '@mantine/core'
import { useState } from 'react'
import { commonParameters, commonValue, MIXED, noteOnAll, setParameterOfAll } from '../../document/editing/bulk'
import { looseValue, shownValue } from '../../document/editing/fields'
import type { EditNode } from '../../document/editing/model'
import { perform } from './apply'
import { toggleDisabled } from './disabled'
import { FormHead, FormLine, FormWords } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { useEditor } from './store'
import { openReplacePalette } from './typeReplacement'

export function SelectionForm({ nodes }: { nodes: readonly EditNode[] }) {
  const catalogue = useEditor((s) => s.catalogue)
  const keysOf = (node: EditNode) =>
    (catalogue?.states.find((each) => each.name === node.state) ?? catalogue?.behaviors.find((each) => each.id === node.document))
      ?.parameters ?? []
  const names = commonParameters((node) => keysOf(node).map((key) => key.name), nodes)
  const areOff = nodes.every((node) => node.disabled !== false)
  const count = `${nodes.length} nodes`
  return (
    <div data-form aria-label={`Form of ${count}`}>
      <FormHead title={count}>{nodes.map((node) => node.name).join(', ')}</FormHead>
      <Section title="Parameters of all">
        {names.length === 0 && <FormWords>They have no parameter in common.</FormWords>}
        {names.map((name) => {
          const value = commonValue(nodes, name)
          return (
            <FormLine key={name} label={name}>
              <TemplateInput
                label={`${name} of all`}
                placeholder={value === MIXED ? 'different values' : 'default'}
                value={value === MIXED ? '' : shownValue(value)}
                onCommit={(typed) =>
                  void perform(`${name} of ${count}`, setParameterOfAll(nodes, name, typed === '' ? undefined : looseValue(typed)))
                }
              />
            </FormLine>
          )
        })}
      </Section>
      <Section title="Type">
        <Button size="xs" variant="default" onClick={() => openReplacePalette(nodes.map((node) => node.path))}>
          Replace {count} by…
        </Button>
      </Section>
      <Section title="Disable">
        <Button size="xs" variant="default" onClick={() => void toggleDisabled(nodes.map((node) => node.path))}>
          {areOff ? `Enable ${count}` : `Disable ${count}`}
        </Button>
      </Section>
      <Section title="Notes">
        <NoteOnAll nodes={nodes} count={count} />
      </Section>
    </div>
  )
}

function NoteOnAll({ nodes, count }: { nodes: readonly EditNode[]; count: string }) {
  const [text, setText] = useState('')
  return (
    <>
      <Textarea
        size="xs"
        autosize
        minRows={2}
        label="The same note on all of them"
        value={text}
        onChange={(event) => setText(event.currentTarget.value)}
      />
      <Button
        size="xs"
        mt="xs"
        variant="default"
        disabled={text.trim() === ''}
        onClick={() => void perform(`Note on ${count}`, noteOnAll(nodes, text))}
      >
        Write note
      </Button>
    </>
  )
}
