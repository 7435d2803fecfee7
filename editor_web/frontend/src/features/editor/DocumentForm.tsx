/** What the behavior itself declares: name, description, outcomes, parameters, userdata. */
import { lookup, without, type Dict } from '../../document/dict'
import { IconPlus, IconTrash } from '@tabler/icons-react'
import { useState, type ReactNode } from 'react'
import type { DocumentInfo } from '../../api/types'
import { looseValue, shownValue } from '../../document/editing/fields'
import { perform } from './apply'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { draftOf, editor, showEditorRefusal, useEditor } from './store'

type Mapping = Dict<unknown>

const TYPES = ['number', 'integer', 'string', 'boolean', 'pose', 'joints', 'list', 'mapping'] as const

/** What is a list or mapping is sent as a whole, and so made of what it is by then. */
function setDocument(words: string, changes: (now: DocumentInfo) => Mapping): void {
  void perform(words, () => {
    const now = draftOf(editor()).document
    return now ? [{ edit: 'set_document', changes: changes(now) }] : []
  })
}

export function DocumentForm() {
  const document = useEditor((s) => draftOf(s).document)
  if (!document) return null
  return (
    <div className="node-form">
      <Section title="Behavior">
        <Line label="Name">
          <TemplateInput
            label="Name of the behavior"
            value={document.name}
            onCommit={(typed) => typed && setDocument('Name', () => ({ name: typed }))}
          />
        </Line>
        <TemplateInput
          label="Description of the behavior"
          isLong
          placeholder="What it does, for operators"
          value={document.description}
          onCommit={(typed) => setDocument('Description', () => ({ description: typed || null }))}
        />
        <Line label="Cell">
          <TemplateInput
            label="Cell"
            isMono
            placeholder="../cells/cell.yaml"
            value={document.cell ?? ''}
            onCommit={(typed) => setDocument('Cell', () => ({ cell: typed || null }))}
          />
        </Line>
      </Section>
      <Section title="Outcomes">
        <Outcomes outcomes={document.outcomes} success={document.success} />
      </Section>
      <Section title="Parameters" note="set for each run">
        <Parameters parameters={document.parameters} />
      </Section>
      <Section title="Userdata" note="values at the beginning">
        <Userdata userdata={document.userdata} />
      </Section>
    </div>
  )
}

function Line({ label, children }: { label: string; children: ReactNode }) {
  return (
    <div className="edit-line">
      <span>{label}</span>
      {children}
    </div>
  )
}

function Outcomes({ outcomes, success }: { outcomes: readonly string[]; success: readonly string[] }) {
  return (
    <>
      <ul className="plain-list outcome-list">
        {outcomes.map((outcome) => (
          <li key={outcome}>
            <label>
              <input
                type="checkbox"
                checked={success.includes(outcome)}
                onChange={({ currentTarget: { checked } }) =>
                  setDocument('Success', (now) => ({
                    success: checked ? [...new Set([...now.success, outcome])] : now.success.filter((each) => each !== outcome),
                  }))
                }
              />
              <span className="mono">{outcome}</span>
              <span className="quiet">{success.includes(outcome) ? 'means success' : ''}</span>
            </label>
            <button
              type="button"
              className="mini"
              aria-label={`Remove the outcome ${outcome}`}
              onClick={() =>
                setDocument(`Remove ${outcome}`, (now) => ({
                  outcomes: now.outcomes.filter((each) => each !== outcome),
                  success: now.success.filter((each) => each !== outcome),
                }))
              }
            >
              <IconTrash size={13} aria-hidden />
            </button>
          </li>
        ))}
      </ul>
      <AddName
        label="New outcome"
        onAdd={(name) => setDocument(`Add ${name}`, (now) => ({ outcomes: [...new Set([...now.outcomes, name])] }))}
        taken={outcomes}
      />
    </>
  )
}

function Parameters({ parameters }: { parameters: Mapping }) {
  const set = (name: string, change: Mapping) =>
    setDocument(`Parameter ${name}`, (now) => {
      const present = mappingOf(lookup(now.parameters, name))
      const next = Object.fromEntries(Object.entries({ ...present, ...change }).filter(([, value]) => value !== undefined && value !== ''))
      return { parameters: { ...now.parameters, [name]: next } }
    })
  return (
    <>
      {Object.entries(parameters).map(([name, given]) => {
        const parameter = mappingOf(given)
        const isNumber = parameter['type'] === 'number' || parameter['type'] === 'integer'
        return (
          <fieldset key={name} className="parameter-card">
            <legend>
              <span className="mono">{name}</span>
              <button
                type="button"
                className="mini"
                aria-label={`Remove the parameter ${name}`}
                onClick={() => setDocument(`Remove ${name}`, (now) => ({ parameters: withoutOrNull(now.parameters, name) }))}
              >
                <IconTrash size={13} aria-hidden />
              </button>
            </legend>
            <Line label="Type">
              <select
                className="plain-input"
                aria-label={`Type of ${name}`}
                value={shownValue(parameter['type'])}
                onChange={(event) => set(name, { type: event.currentTarget.value })}
              >
                {TYPES.map((type) => (
                  <option key={type} value={type}>
                    {type}
                  </option>
                ))}
              </select>
            </Line>
            <Line label="Default">
              <TemplateInput
                label={`Default of ${name}`}
                placeholder="must be given"
                value={shownValue(parameter['default'])}
                onCommit={(typed) =>
                  set(name, {
                    default: typed === '' ? undefined : parameter['type'] === 'string' ? typed : looseValue(typed),
                  })
                }
              />
            </Line>
            {isNumber && (
              <div className="edit-line three">
                <TemplateInput
                  label={`Minimum of ${name}`}
                  inputMode="decimal"
                  placeholder="min"
                  value={shownValue(parameter['minimum'])}
                  onCommit={(typed) => set(name, { minimum: typed === '' ? undefined : looseValue(typed) })}
                />
                <TemplateInput
                  label={`Maximum of ${name}`}
                  inputMode="decimal"
                  placeholder="max"
                  value={shownValue(parameter['maximum'])}
                  onCommit={(typed) => set(name, { maximum: typed === '' ? undefined : looseValue(typed) })}
                />
                <TemplateInput
                  label={`Unit of ${name}`}
                  placeholder="unit"
                  value={shownValue(parameter['unit'])}
                  onCommit={(typed) => set(name, { unit: typed })}
                />
              </div>
            )}
            <TemplateInput
              label={`Description of ${name}`}
              placeholder="What it means"
              value={shownValue(parameter['description'])}
              onCommit={(typed) => set(name, { description: typed })}
            />
          </fieldset>
        )
      })}
      <AddName
        label="New parameter"
        taken={Object.keys(parameters)}
        onAdd={(name) =>
          setDocument(`Add ${name}`, (now) => ({
            parameters: { ...now.parameters, [name]: { type: 'number', default: 0 } },
          }))
        }
      />
    </>
  )
}

function Userdata({ userdata }: { userdata: Mapping }) {
  return (
    <>
      {Object.entries(userdata).map(([name, value]) => (
        <div key={name} className="edit-line">
          <span className="mono">{name}</span>
          <TemplateInput
            label={`Value of ${name}`}
            isMono
            value={value === null ? 'null' : shownValue(value)}
            onCommit={(typed) => setDocument(`Userdata ${name}`, (now) => ({ userdata: { ...now.userdata, [name]: looseValue(typed) } }))}
          />
          <button
            type="button"
            className="mini"
            aria-label={`Remove the key ${name}`}
            onClick={() => setDocument(`Remove ${name}`, (now) => ({ userdata: withoutOrNull(now.userdata, name) }))}
          >
            <IconTrash size={13} aria-hidden />
          </button>
        </div>
      ))}
      <AddName
        label="New key"
        taken={Object.keys(userdata)}
        onAdd={(name) => setDocument(`Add ${name}`, (now) => ({ userdata: { ...now.userdata, [name]: 0 } }))}
      />
    </>
  )
}

function AddName({ label, taken, onAdd }: { label: string; taken: readonly string[]; onAdd: (name: string) => void }) {
  const [name, setName] = useState('')
  return (
    <form
      className="add-name"
      onSubmit={(event) => {
        event.preventDefault()
        const typed = name.trim()
        if (!/^[A-Za-z_][A-Za-z0-9_]{0,63}$/.test(typed)) showEditorRefusal(label, 'a name has letters, digits and _')
        else if (taken.includes(typed)) showEditorRefusal(label, `there is a ${typed} already`)
        else {
          onAdd(typed)
          setName('')
        }
      }}
    >
      <input
        className="plain-input"
        aria-label={label}
        placeholder={label}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
      />
      <button type="submit" className="command" aria-label={`Add: ${label}`}>
        <IconPlus size={14} aria-hidden />
      </button>
    </form>
  )
}

function mappingOf(value: unknown): Mapping {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Mapping) : {}
}

function withoutOrNull(mapping: Mapping, name: string): Mapping | null {
  const rest = without(mapping, name)
  return Object.keys(rest).length > 0 ? rest : null
}
