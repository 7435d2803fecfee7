/** The parameters of a state or behavior, each in the field that fits it; `${…}` is possible in all of them. */
import { lookup } from '../../document/dict'
import { Flex, Space, Stack, Text } from '@mantine/core'
import { IconBraces, IconGauge, IconX } from '@tabler/icons-react'
import { useId, useState } from 'react'
import type { KeyView } from '../../api/types'
import { editFieldOf, fieldProblem, isTemplate, limitsText, shownValue, typedValue, type EditField } from '../../document/editing/fields'
import type { EditNode } from '../../document/editing/model'
import { unknownName, type Surroundings } from '../../document/editing/offers'
import { armOf } from '../../document/editing/preview'
import { Words } from '../../components/Words'
import { perform } from './apply'
import { FormWords } from './FormParts'
import { MeasuredNow } from './MeasuredNow'
import { ParameterInput } from './ParameterInput'
import { FieldPreview } from './ShowEntry'
import { TeachTool } from './TeachTool'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'
import { useSurroundings } from './useSurroundings'

export function ParameterFields({ node, keys }: { node: EditNode; keys: readonly KeyView[] }) {
  const [isFocused, setFocused] = useState(false)
  const around = useSurroundings(node, isFocused)
  const known = new Set(keys.map((key) => key.name))
  const undeclared = Object.keys(node.parameters).filter((name) => !known.has(name))
  return (
    <Stack gap="xs" data-parameters onFocus={() => setFocused(true)}>
      {keys.map((key) => (
        <ParameterRow key={key.name} node={node} field={editFieldOf(key)} around={around} />
      ))}
      {undeclared.map((name) => (
        <UndeclaredRow key={name} node={node} name={name} isKnown={keys.length > 0} />
      ))}
      {keys.length + undeclared.length === 0 && <FormWords>It has no parameters.</FormWords>}
    </Stack>
  )
}

function setParameter(node: EditNode, name: string, value: unknown): void {
  void perform(
    `Set ${name} of ${node.name}`,
    value === undefined ? [{ edit: 'clear_parameter', path: node.path, name }] : [{ edit: 'set_parameter', path: node.path, name, value }],
  )
}

function ParameterRow({ node, field, around }: { node: EditNode; field: EditField; around: Surroundings }) {
  const value = lookup(node.parameters, field.name)
  const [asTemplate, setAsTemplate] = useState(isTemplate(value))
  const [pointed, setPointed] = useState<string>()
  const [isMeasured, setMeasured] = useState(false)
  const problem = fieldProblem(field, value) ?? unknownName(field, value, around)
  const hintId = useId()
  const limits = limitsText(field)
  const set = (next: unknown) => setParameter(node, field.name, next)
  const isFree = asTemplate || isTemplate(value)
  return (
    <div data-field={field.name} data-problem={problem !== undefined || undefined}>
      <Flex align="center" gap={4} mih={22} fz="sm" fw={560}>
        <span>{field.name}</span>
        {field.required && (
          <Text span inherit c="var(--failed)" aria-hidden>
            *
          </Text>
        )}
        {limits && (
          <Text span size="xs" c="dimmed" ml={4} id={`${hintId}-limits`}>
            {limits}
          </Text>
        )}
        <Space flex={1} />
        {value !== undefined && !field.required && (
          <Tool
            isSmall
            label={`Take ${field.name} back to its default`}
            title={`Default: ${shownValue(field.fallback) || 'none'}`}
            onPress={() => set(undefined)}
          >
            <IconX size={13} aria-hidden />
          </Tool>
        )}
        <TeachTool node={node} field={field} value={value} around={around} onSet={set} />
        {field.measuredOn && (
          <Tool
            isSmall
            isPressed={isMeasured}
            label={`Show what is measured for ${field.name}`}
            title="Show what is measured now"
            onPress={() => setMeasured(!isMeasured)}
          >
            <IconGauge size={13} aria-hidden />
          </Tool>
        )}
        <Tool
          isSmall
          isPressed={isFree}
          label={`Write ${field.name} as an expression`}
          title="Write it as ${…}"
          onPress={() => setAsTemplate(!asTemplate)}
        >
          <IconBraces size={13} aria-hidden />
        </Tool>
      </Flex>
      <ParameterInput
        field={field}
        value={value}
        isFree={isFree}
        around={around}
        hintId={limits ? `${hintId} ${hintId}-limits` : hintId}
        isInvalid={problem !== undefined}
        onSet={set}
        onPoint={setPointed}
      />
      {isMeasured && (
        <MeasuredNow field={field} value={value} arm={armOf(node.parameters, around.parameters, lookup(around.names, 'robot'))} />
      )}
      {field.kind === 'entry' && <FieldPreview node={node} field={field} value={value} entries={around.entries} pointed={pointed} />}
      <Text size="xs" mt={2} c={problem ? 'var(--failed)' : 'dimmed'} id={hintId}>
        <Words text={problem ?? field.description} />
      </Text>
    </div>
  )
}

/** A value that its state does not know, or a parameter of a state that is not known. */
function UndeclaredRow({ node, name, isKnown }: { node: EditNode; name: string; isKnown: boolean }) {
  return (
    <div data-field={name} data-problem={isKnown || undefined}>
      <Flex align="center" gap={4} mih={22} fz="sm" fw={560}>
        <span>{name}</span>
        <Space flex={1} />
        <Tool isSmall label={`Remove ${name}`} onPress={() => setParameter(node, name, undefined)}>
          <IconX size={13} aria-hidden />
        </Tool>
      </Flex>
      <TemplateInput
        label={name}
        isMono
        value={shownValue(lookup(node.parameters, name))}
        onCommit={(typed) => setParameter(node, name, typedValue({ kind: 'data' }, typed))}
      />
      {isKnown && (
        <Text size="xs" mt={2} c="var(--failed)">
          There is no such parameter.
        </Text>
      )}
    </div>
  )
}
