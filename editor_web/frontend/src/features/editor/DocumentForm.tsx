/** What the behavior itself declares: name, description, outcomes, parameters, userdata. */
import { lookup, without, type Dict } from '../../document/dict'
import { ActionIcon, Checkbox, Code, Fieldset, Group, NativeSelect, SimpleGrid, Stack, Text, TextInput } from '@mantine/core'
import { IconPlus, IconTrash } from '@tabler/icons-react'
import { useMemo, useState } from 'react'
import type { DocumentInfo } from '../../api/types'
import { looseValue, shownValue } from '../../document/editing/fields'
import { fittingNames, nameKindOf, nameKinds, namingOf, type NameSources } from '../../document/editing/parameterNames'
import { perform } from './apply'
import { FormLine } from './FormParts'
import { PlainList } from './PlainList'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { Tool } from './Tool'
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
    <div data-form>
      <Section title="Behavior">
        <FormLine label="Name">
          <TemplateInput
            label="Name of the behavior"
            value={document.name}
            onCommit={(typed) => typed && setDocument('Name', () => ({ name: typed }))}
          />
        </FormLine>
        <TemplateInput
          label="Description of the behavior"
          isLong
          placeholder="What it does, for operators"
          value={document.description}
          onCommit={(typed) => setDocument('Description', () => ({ description: typed || null }))}
        />
        <FormLine label="Cell">
          <TemplateInput
            label="Cell"
            isMono
            placeholder="../cells/cell.yaml"
            value={document.cell ?? ''}
            onCommit={(typed) => setDocument('Cell', () => ({ cell: typed || null }))}
          />
        </FormLine>
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

function Outcomes({ outcomes, success }: { outcomes: readonly string[]; success: readonly string[] }) {
  return (
    <>
      <PlainList>
        {outcomes.map((outcome) => (
          <li key={outcome}>
            <Group justify="space-between" mih={28}>
              <Checkbox
                size="xs"
                label={
                  <>
                    <Code bg="none" p={0}>
                      {outcome}
                    </Code>{' '}
                    <Text span size="xs" c="dimmed">
                      {success.includes(outcome) ? 'means success' : ''}
                    </Text>
                  </>
                }
                checked={success.includes(outcome)}
                onChange={({ currentTarget: { checked } }) =>
                  setDocument('Success', (now) => ({
                    success: checked ? [...new Set([...now.success, outcome])] : now.success.filter((each) => each !== outcome),
                  }))
                }
              />
              <Remove
                label={`Remove the outcome ${outcome}`}
                onPress={() =>
                  setDocument(`Remove ${outcome}`, (now) => ({
                    outcomes: now.outcomes.filter((each) => each !== outcome),
                    success: now.success.filter((each) => each !== outcome),
                  }))
                }
              />
            </Group>
          </li>
        ))}
      </PlainList>
      <AddName
        label="New outcome"
        onAdd={(name) => setDocument(`Add ${name}`, (now) => ({ outcomes: [...new Set([...now.outcomes, name])] }))}
        taken={outcomes}
      />
    </>
  )
}

const NO_NAMES: NameSources['names'] = {}
const NO_ENTRIES: NameSources['entries'] = []

/** The names of the document's own cell, and the entries of the open one. */
function useNameSources(): NameSources {
  const names = useEditor((s) => s.names ?? s.catalogue?.names ?? NO_NAMES)
  const entries = useEditor((s) => s.catalogue?.entries ?? NO_ENTRIES)
  return useMemo(() => ({ names, entries }), [names, entries])
}

function Parameters({ parameters }: { parameters: Mapping }) {
  const set = (name: string, change: Mapping) =>
    setDocument(`Parameter ${name}`, (now) => {
      const present = mappingOf(lookup(now.parameters, name))
      const next = Object.fromEntries(Object.entries({ ...present, ...change }).filter(([, value]) => value !== undefined && value !== ''))
      return { parameters: { ...now.parameters, [name]: next } }
    })
  const sources = useNameSources()
  return (
    <>
      {Object.entries(parameters).map(([name, given]) => {
        const parameter = mappingOf(given)
        const isNumber = parameter['type'] === 'number' || parameter['type'] === 'integer'
        return (
          <Fieldset
            key={name}
            px="xs"
            pt={0}
            pb="xs"
            legend={
              <Group gap={4}>
                <Code bg="none" p={0} fw={600}>
                  {name}
                </Code>
                <Remove
                  label={`Remove the parameter ${name}`}
                  onPress={() => setDocument(`Remove ${name}`, (now) => ({ parameters: withoutOrNull(now.parameters, name) }))}
                />
              </Group>
            }
          >
            <Stack gap={6}>
              <FormLine label="Type">
                <NativeSelect
                  size="xs"
                  aria-label={`Type of ${name}`}
                  value={shownValue(parameter['type'])}
                  onChange={(event) => set(name, { type: event.currentTarget.value })}
                  data={[...TYPES]}
                />
              </FormLine>
              {parameter['type'] === 'string' && (
                <FormLine label="Names">
                  <NativeSelect
                    size="xs"
                    aria-label={`What ${name} names`}
                    value={nameKindOf(parameter)}
                    onChange={(event) => set(name, namingOf(event.currentTarget.value))}
                    data={[{ value: '', label: 'nothing of the cell' }, ...nameKinds(sources, parameter)]}
                  />
                </FormLine>
              )}
              <FormLine label="Default">
                <TemplateInput
                  label={`Default of ${name}`}
                  options={fittingNames(sources, parameter)}
                  placeholder="must be given"
                  value={shownValue(parameter['default'])}
                  onCommit={(typed) =>
                    set(name, {
                      default: typed === '' ? undefined : parameter['type'] === 'string' ? typed : looseValue(typed),
                    })
                  }
                />
              </FormLine>
              {isNumber && (
                <SimpleGrid cols={3} spacing={6}>
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
                </SimpleGrid>
              )}
              <TemplateInput
                label={`Description of ${name}`}
                placeholder="What it means"
                value={shownValue(parameter['description'])}
                onCommit={(typed) => set(name, { description: typed })}
              />
            </Stack>
          </Fieldset>
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
        <FormLine
          key={name}
          label={
            <Code bg="none" p={0}>
              {name}
            </Code>
          }
        >
          <TemplateInput
            label={`Value of ${name}`}
            isMono
            value={value === null ? 'null' : shownValue(value)}
            onCommit={(typed) => setDocument(`Userdata ${name}`, (now) => ({ userdata: { ...now.userdata, [name]: looseValue(typed) } }))}
          />
          <Remove
            label={`Remove the key ${name}`}
            onPress={() => setDocument(`Remove ${name}`, (now) => ({ userdata: withoutOrNull(now.userdata, name) }))}
          />
        </FormLine>
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
      <Group gap={6} wrap="nowrap">
        <TextInput
          size="xs"
          flex={1}
          aria-label={label}
          placeholder={label}
          value={name}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <ActionIcon type="submit" variant="default" size={30} aria-label={`Add: ${label}`}>
          <IconPlus size={14} aria-hidden />
        </ActionIcon>
      </Group>
    </form>
  )
}

function Remove({ label, onPress }: { label: string; onPress: () => void }) {
  return (
    <Tool isSmall label={label} onPress={onPress}>
      <IconTrash size={13} aria-hidden />
    </Tool>
  )
}

function mappingOf(value: unknown): Mapping {
  return typeof value === 'object' && value !== null && !Array.isArray(value) ? (value as Mapping) : {}
}

function withoutOrNull(mapping: Mapping, name: string): Mapping | null {
  const rest = without(mapping, name)
  return Object.keys(rest).length > 0 ? rest : null
}
