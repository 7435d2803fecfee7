/** The properties of one item: what is changed here is seen in 3D at once, and in the document when it is applied. */
import { Button, Group, NativeSelect, ScrollArea, Stack, Text, TextInput } from '@mantine/core'
import { IconAlertTriangle, IconHandFinger, IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import { CommandButton } from '../../components/CommandButton'
import { Refusal } from '../../components/Refusal'
import { namingBehaviorsQuery } from '../../api/cellDocuments'
import { useLive } from '../../api/live'
import { useAnswer } from '../../api/queryClient'
import type { DraftItem } from '../../api/types'
import { askWizard } from '../../api/valueWizard'
import { withoutEntry } from '../../document/cellDevices'
import { editsBetween, groupsFor, itemAddress, nameFault, withField } from '../../document/cellEditing'
import { keyOf, valueAt, type Surroundings } from '../../document/cellFields'
import { canDrag, canTurn, DRAG_STEPS, draggedTo, taughtAt, taughtPose, type DragSteps } from '../../document/cellPlacing'
import { shownItem } from '../../document/cellShown'
import { lookup, type Dict } from '../../document/dict'
import type { PlacedPose } from '../../document/poses'
import { AddEntry, EntryGroup } from './EntryGroup'
import { FieldInput, fieldFault } from './FieldInput'
import { edit } from './session'
import { cellEditor, draftOf, setCellEditor, useCellEditor } from './store'
import { useItemHandle } from './useItemHandle'
import { useShownItem } from './useShownItem'

interface ItemFormProps {
  readonly item: DraftItem
  readonly surroundings: Surroundings
  readonly onSelect: (address: string) => void
}

export function ItemForm({ item, surroundings, onSelect }: ItemFormProps) {
  const { section, name, value } = item
  const [next, setNext] = useState(value)
  const [newName, setNewName] = useState(name)
  const [entryNames, setEntryNames] = useState<Dict<string>>({})
  const [axis, setAxis] = useState('')
  const draft = useCellEditor(draftOf)
  const kind = useCellEditor((s) => draftOf(s).kind)
  const findings = useCellEditor((s) => draftOf(s).findings)
  const { value: naming } = useAnswer(namingBehaviorsQuery(kind === 'cell' && newName !== name ? name : ''))
  const path = `${section}/${name}`
  const groups = groupsFor(section, next, {
    ...surroundings,
    // Nothing stands in itself; the connector that a module has is not free for others.
    frames: surroundings.frames.filter((each) => each !== name && !each.startsWith(`${name}/`)),
  })
  const fields = groups.flatMap((each) => each.fields)
  const edits = editsBetween(item, next, newName, fields, entryNames)
  const names = [newName, ...Object.values(entryNames)]
  const fault =
    names.map(nameFault).find((each) => each !== undefined) ??
    fields.map((field) => fieldFault(field, valueAt(next, field.path))).find((each) => each !== undefined)
  const arms = useLive((s) => Object.keys(s.robots).length)
  const steps = useCellEditor((s) => s.steps)
  const shown = kind === 'cell' ? shownItem(section, next, draft, axis) : undefined
  const touching = useCellEditor((s) => s.rest).filter((each) => each.path === path)
  useShownItem(shown, touching.length > 0)
  useItemHandle(canDrag(section) && steps !== 'off' ? shown?.pose : undefined, canTurn(section), (pose) => {
    if (steps !== 'off') setNext((now) => draggedTo({ section, name, value: now }, pose, draftOf(cellEditor()), steps))
  })

  /** Its place in the world as the arms are now; what it stands in is where the draft says. */
  function teach(pose: PlacedPose): void {
    askWizard({
      kind: 'pose',
      title: name,
      arm: '',
      value: { xyz: pose.xyz, xyzw: pose.xyzw },
      form: 'xyzw',
      frames: [],
      meant: (frame) => frame,
      isFrame: true,
      onSet: (made) => {
        const taught = taughtPose(made)
        if (taught) setNext((now) => taughtAt({ section, value: now }, taught, draftOf(cellEditor())))
      },
    })
  }

  async function apply(): Promise<void> {
    if (edits.length === 0 || fault !== undefined) return
    const isMade = await edit(newName === name ? `Change ${name}` : `Rename ${name}`, edits)
    if (isMade && newName !== name) onSelect(itemAddress({ section, name: newName }))
  }

  async function remove(): Promise<void> {
    if (await edit(`Delete ${name}`, [{ edit: 'remove_item', section, name }])) onSelect('')
  }

  return (
    <Stack
      component="form"
      h="100%"
      gap={0}
      aria-label={`Change ${name}`}
      onSubmit={(event) => {
        event.preventDefault()
        void apply()
      }}
    >
      <ScrollArea flex={1} viewportProps={{ tabIndex: 0, role: 'region', 'aria-label': `Properties of ${name}` }}>
        <Stack gap="xs" p="sm">
          {findings
            .filter((each) => each.path === path)
            .map((each) => (
              <Refusal key={`${each.line} ${each.message}`} hint={each.hint}>
                {each.message}
              </Refusal>
            ))}
          {touching.map((each) => (
            <Text key={each.message} size="xs" c="var(--stopped)" role="status">
              <IconAlertTriangle size={13} aria-hidden /> {each.message} – {each.hint}
            </Text>
          ))}
          <TextInput
            size="xs"
            label="Name"
            value={newName}
            error={nameFault(newName)}
            onChange={(event) => setNewName(event.currentTarget.value)}
          />
          {newName !== name && (
            <Text size="xs" c="dimmed" role="status">
              All that names it in this document follows. Taught entries do not, and{' '}
              {naming === undefined
                ? 'behaviors neither.'
                : naming.length === 0
                  ? 'no saved behavior names it.'
                  : `neither do these behaviors: ${naming.map((each) => `${each.name} (${each.paths.length})`).join(', ')}.`}
            </Text>
          )}
          {groups.map((group) => {
            const [of = '', entry = ''] = group.entry ?? []
            const key = keyOf([of, entry])
            return (
              <EntryGroup
                key={group.title}
                group={group}
                newName={lookup(entryNames, key) ?? entry}
                onName={(to) => setEntryNames({ ...entryNames, [key]: to })}
                onRemove={() => setNext(withoutEntry(next, of, entry))}
                onFocus={() => of === 'axes' && setAxis(entry)}
              >
                {group.fields.map((field) => (
                  <FieldInput
                    key={keyOf(field.path)}
                    field={field}
                    value={valueAt(next, field.path)}
                    onChange={(made) => setNext(withField(next, field, made))}
                  />
                ))}
              </EntryGroup>
            )
          })}
          {section === 'devices' && <AddEntry device={next} surroundings={surroundings} onAdd={setNext} />}
          {fault !== undefined && (
            <Text size="xs" c="var(--failed)" role="status">
              {fault}
            </Text>
          )}
          {kind === 'cell' && canTurn(section) && (
            <CommandButton
              label="Teach with an arm"
              icon={<IconHandFinger size={14} aria-hidden />}
              hint="Its place by three points of the tool, or by the pose of the tool"
              obstacle={arms === 0 ? 'the open cell has no arm' : shown ? undefined : 'where it stands in is not known'}
              onPress={() => shown && teach(shown.pose)}
            />
          )}
          {kind === 'cell' && canDrag(section) && (
            <NativeSelect
              size="xs"
              label="Drag in the 3D view"
              description="By the arrows and rings, in these steps, or onto a connector"
              value={steps}
              data={[{ value: 'off', label: 'off' }, ...Object.entries(DRAG_STEPS).map(([key, { label }]) => ({ value: key, label }))]}
              onChange={(event) => setCellEditor({ steps: event.currentTarget.value as DragSteps })}
            />
          )}
        </Stack>
      </ScrollArea>
      <Group gap="xs" px="sm" py="xs" flex="none">
        <Button type="submit" size="xs" disabled={edits.length === 0 || fault !== undefined} title={fault ?? ''}>
          Apply
        </Button>
        <Button
          size="xs"
          variant="default"
          disabled={edits.length === 0}
          onClick={() => {
            setNext(value)
            setNewName(name)
            setEntryNames({})
          }}
        >
          Reset
        </Button>
        <CommandButton label="Delete" of={name} tone="danger" icon={<IconTrash size={14} aria-hidden />} onPress={() => void remove()} />
      </Group>
    </Stack>
  )
}
