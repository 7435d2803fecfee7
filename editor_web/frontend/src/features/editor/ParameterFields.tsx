/** The parameters of a state or behavior, each in the field that fits it; `${…}` is possible in all of them. */
import { lookup, type Dict } from '../../document/dict'
import { Switch } from '@mantine/core'
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
import { FieldPreview } from './ShowEntry'
import { TemplateInput } from './TemplateInput'
import { useEditor } from './store'

export function ParameterFields({ node, keys }: { node: EditNode; keys: readonly KeyView[] }) {
  const entries = useEditor((s) => s.catalogue?.entries ?? NO_ENTRIES)
  const known = new Set(keys.map((key) => key.name))
  const undeclared = Object.keys(node.parameters).filter((name) => !known.has(name))
  return (
    <div className="edit-fields">
      {keys.map((key) => (
        <ParameterRow key={key.name} node={node} field={editFieldOf(key)} entries={entries} />
      ))}
      {undeclared.map((name) => (
        <UndeclaredRow key={name} node={node} name={name} isKnown={keys.length > 0} />
      ))}
      {keys.length + undeclared.length === 0 && <p className="quiet">It has no parameters.</p>}
    </div>
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
    <div className={`edit-field${problem ? ' has-problem' : ''}`}>
      <div className="edit-label">
        <span>{field.name}</span>
        {field.required && (
          <span className="required" aria-hidden>
            *
          </span>
        )}
        {limits && (
          <span className="field-range" id={`${hintId}-limits`}>
            {limits}
          </span>
        )}
        <span className="spacer" />
        {value !== undefined && !field.required && (
          <button
            type="button"
            className="mini"
            aria-label={`Take ${field.name} back to its default`}
            title={`Default: ${shownValue(field.fallback) || 'none'}`}
            onClick={() => set(undefined)}
          >
            <IconX size={13} aria-hidden />
          </button>
        )}
        <button
          type="button"
          className="mini"
          aria-pressed={isFree}
          aria-label={`Write ${field.name} as an expression`}
          title="Write it as ${…}"
          onClick={() => setAsTemplate(!asTemplate)}
        >
          <IconBraces size={13} aria-hidden />
        </button>
      </div>
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
      <div className="edit-hint" id={hintId}>
        {problem ? <span className="is-failed">{problem}</span> : field.description}
      </div>
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
        <select
          className="plain-input"
          aria-label={label}
          aria-describedby={hintId}
          value={plainText(value)}
          onChange={(event) => onSet(event.currentTarget.value === '' ? undefined : event.currentTarget.value)}
        >
          <option value="">{field.required ? 'choose' : `default${fallback ? `: ${fallback}` : ''}`}</option>
          {field.choices.map((choice) => (
            <option key={choice} value={choice}>
              {choice}
            </option>
          ))}
        </select>
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
    <div className="vector">
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
    </div>
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
    <div className={`edit-field${isKnown ? ' has-problem' : ''}`}>
      <div className="edit-label">
        <span>{name}</span>
        <span className="spacer" />
        <button type="button" className="mini" aria-label={`Remove ${name}`} onClick={() => setParameter(node, name, undefined)}>
          <IconX size={13} aria-hidden />
        </button>
      </div>
      <TemplateInput
        label={name}
        isMono
        value={shownValue(lookup(node.parameters, name))}
        onCommit={(typed) => setParameter(node, name, typedValue({ kind: 'data' }, typed))}
      />
      {isKnown && <div className="edit-hint is-failed">There is no such parameter.</div>}
    </div>
  )
}
