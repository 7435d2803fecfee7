/** The parameters of a state or behavior, each in the field that fits it; `${…}` is possible in all of them. */
import { lookup, type Dict } from '../../document/dict'
import { Flex, NativeSelect, SimpleGrid, Space, Stack, Switch, Text } from '@mantine/core'
import { IconBraces, IconX } from '@tabler/icons-react'
import { useId, useState } from 'react'
import type { EntryName, KeyView } from '../../api/types'
import {
  editFieldOf,
  fieldProblem,
  fittingNames,
  isTemplate,
  limitsText,
  looseValue,
  shownValue,
  typedValue,
  type EditField,
} from '../../document/editing/fields'
import type { EditNode } from '../../document/editing/model'
import { plainText } from '../../document/values'
import { perform } from './apply'
import { EntryDetails } from './EntryDetails'
import { FormWords } from './FormParts'
import { FieldPreview } from './ShowEntry'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'
import { useEditor } from './store'

export function ParameterFields({ node, keys }: { node: EditNode; keys: readonly KeyView[] }) {
  const entries = useEditor((s) => s.catalogue?.entries ?? NO_ENTRIES)
  const known = new Set(keys.map((key) => key.name))
  const undeclared = Object.keys(node.parameters).filter((name) => !known.has(name))
  return (
    <Stack gap="xs" data-parameters>
      {keys.map((key) => (
        <ParameterRow key={key.name} node={node} field={editFieldOf(key)} entries={entries} />
      ))}
      {undeclared.map((name) => (
        <UndeclaredRow key={name} node={node} name={name} isKnown={keys.length > 0} />
      ))}
      {keys.length + undeclared.length === 0 && <FormWords>It has no parameters.</FormWords>}
    </Stack>
  )
}

const NO_ENTRIES: readonly EntryName[] = []
const NO_NAMES: Dict<readonly string[]> = {}

function setParameter(node: EditNode, name: string, value: unknown): void {
  void perform(
    `Set ${name} of ${node.name}`,
    value === undefined ? [{ edit: 'clear_parameter', path: node.path, name }] : [{ edit: 'set_parameter', path: node.path, name, value }],
  )
}

function ParameterRow({ node, field, entries }: { node: EditNode; field: EditField; entries: readonly EntryName[] }) {
  const value = lookup(node.parameters, field.name)
  const [asTemplate, setAsTemplate] = useState(isTemplate(value))
  const [pointed, setPointed] = useState<string>()
  const problem = fieldProblem(field, value)
  const hintId = useId()
  const limits = limitsText(field)
  const set = (next: unknown) => setParameter(node, field.name, next)
  const names = useEditor((s) => s.names ?? s.catalogue?.names ?? NO_NAMES)
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
      <FieldInput
        field={field}
        value={value}
        isFree={isFree}
        entries={entries}
        names={fittingNames(field, names, node.parameters)}
        hintId={limits ? `${hintId} ${hintId}-limits` : hintId}
        isInvalid={problem !== undefined}
        onSet={set}
        onPoint={setPointed}
      />
      {field.kind === 'entry' && <FieldPreview node={node} field={field} value={value} entries={entries} pointed={pointed} />}
      <Text size="xs" mt={2} c={problem ? 'var(--failed)' : 'dimmed'} id={hintId}>
        {problem ?? field.description}
      </Text>
    </div>
  )
}

interface InputProps {
  readonly field: EditField
  readonly value: unknown
  readonly isFree: boolean
  readonly entries: readonly EntryName[]
  /** Names of the cell to choose from. */
  readonly names: readonly string[]
  readonly hintId: string
  readonly isInvalid: boolean
  readonly onSet: (value: unknown) => void
  /** A choice of the opened list is pointed at. */
  readonly onPoint: (option: string | undefined) => void
}

function FieldInput({ field, value, isFree, entries, names, hintId, isInvalid, onSet, onPoint }: InputProps) {
  const label = field.name
  const fallback = shownValue(field.fallback)
  const shared = { label, describedBy: hintId, isInvalid, placeholder: field.required ? '' : fallback || 'not given' }
  if (isFree) {
    const shown = value === undefined ? '${' : shownValue(value)
    return (
      <TemplateInput
        {...shared}
        isMono
        value={shown === '${' ? '' : shown}
        placeholder="${name}"
        onCommit={(typed) => onSet(typedValue(field, typed))}
      />
    )
  }
  switch (field.kind) {
    case 'boolean':
      return (
        <Switch
          size="sm"
          aria-label={label}
          checked={(value ?? field.fallback) === true}
          onChange={(event) => onSet(event.currentTarget.checked)}
        />
      )
    case 'choice':
      return (
        <NativeSelect
          size="xs"
          aria-label={label}
          aria-describedby={hintId}
          value={plainText(value)}
          data={[{ value: '', label: field.required ? 'choose' : `default${fallback ? `: ${fallback}` : ''}` }, ...field.choices]}
          onChange={(event) => onSet(event.currentTarget.value === '' ? undefined : event.currentTarget.value)}
        />
      )
    case 'vector':
      return <VectorInput field={field} value={value} onSet={onSet} />
    case 'entry':
      return <EntryInput field={field} value={value} entries={entries} shared={shared} onSet={onSet} onPoint={onPoint} />
    default:
      return (
        <TemplateInput
          {...shared}
          isMono={field.kind === 'data'}
          {...(names.length > 0 ? { options: names } : {})}
          inputMode={field.kind === 'number' || field.kind === 'integer' ? 'decimal' : 'text'}
          value={shownValue(value)}
          onCommit={(typed) => onSet(typedValue(field, typed))}
        />
      )
  }
}

/** Numbers beside one another, `x`, `y`, `z`. */
function VectorInput({ field, value, onSet }: { field: EditField; value: unknown; onSet: (value: unknown) => void }) {
  const given = Array.isArray(value) ? (value as unknown[]) : undefined
  const base = given ?? (Array.isArray(field.fallback) ? (field.fallback as unknown[]) : field.parts.map(() => 0))
  return (
    <SimpleGrid cols={field.parts.length} spacing={5}>
      {field.parts.map((part, index) => (
        <TemplateInput
          key={part}
          label={`${field.name} ${part}`}
          inputMode="decimal"
          value={given ? shownValue(given[index]) : ''}
          placeholder={shownValue(base[index]) || part}
          onCommit={(typed) => onSet(field.parts.map((_, at) => (at === index ? looseValue(typed || '0') : base[at])))}
        />
      ))}
    </SimpleGrid>
  )
}

interface EntryProps {
  readonly field: EditField
  readonly value: unknown
  readonly entries: readonly EntryName[]
  readonly shared: {
    readonly label: string
    readonly describedBy: string
    readonly isInvalid: boolean
    readonly placeholder: string
  }
  readonly onSet: (value: unknown) => void
  readonly onPoint: (option: string | undefined) => void
}

/** A named entry of the store, to be chosen from those of its kind; or the whole value as data. */
function EntryInput({ field, value, entries, shared, onSet, onPoint }: EntryProps) {
  const named = nameIn(value)
  const fitting = entries.filter((entry) => !field.entryKind || entry.kind === field.entryKind).map((entry) => entry.name)
  const isData = value !== undefined && value !== null && named === undefined
  if (isData)
    return (
      <TemplateInput {...shared} isMono isLong value={shownValue(value)} onCommit={(typed) => onSet(typedValue({ kind: 'data' }, typed))} />
    )
  const chosen = entries.find((entry) => entry.name === named && (!field.entryKind || entry.kind === field.entryKind))
  return (
    <>
      <TemplateInput
        {...shared}
        placeholder={fitting.length > 0 ? 'choose an entry' : 'name of an entry'}
        options={fitting}
        onPoint={onPoint}
        value={named ?? ''}
        onCommit={(typed) => {
          if (typed === '') onSet(undefined)
          else if (typed.startsWith('{') || typed.startsWith('[')) onSet(looseValue(typed))
          else onSet(field.isPlainEntry ? typed : { entry: typed })
        }}
      />
      {chosen && <EntryDetails kind={chosen.kind} name={chosen.name} />}
    </>
  )
}

function nameIn(value: unknown): string | undefined {
  if (typeof value === 'string') return value
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return undefined
  const keys = Object.keys(value)
  const { entry } = value as { entry?: unknown }
  return keys.length === 1 && typeof entry === 'string' ? entry : undefined
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
