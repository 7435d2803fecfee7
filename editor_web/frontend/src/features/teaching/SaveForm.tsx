/** Saves a capture as a named entry; overwriting one says first what that changes. */
import { Alert, Group, List, NativeSelect, Paper, SimpleGrid, Stack, Text, TextInput } from '@mantine/core'
import { IconDeviceFloppy } from '@tabler/icons-react'
import { useDebouncedValue } from '@mantine/hooks'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { entryQueries } from '../../api/entries'
import { useAnswer } from '../../api/queryClient'
import { teach, useDisabledReason } from '../../api/teaching'
import type { CaptureSummary, PrimitiveComparison, Trace } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { changesOf, endOf, nameFault, tagFault, tagsOf } from '../../document/teaching'
import { FORM_WORDS, formsOf, type Form } from './forms'
import { Refusal } from '../../components/Refusal'

const TYPING_MS = 250

interface SaveFormProps {
  readonly capture: CaptureSummary
  readonly fit: PrimitiveComparison | undefined
  readonly arm: string
}

export function SaveForm({ capture, fit, arm }: SaveFormProps) {
  const [name, setName] = useState('')
  const [form, setForm] = useState<Form>(capture.form)
  const [tags, setTags] = useState('')
  const [reason, setReason] = useState('')
  const [message, setMessage] = useState('')
  const [problem, setProblem] = useState('')
  const off = useDisabledReason()
  const fault = nameFault(name)
  const wrongTags = tagFault(tags)
  const present = usePresent(arm, form, fault ? '' : name)
  const changes = present.trace && fit ? changesOf(present.trace, asForm(fit, form)) : []
  const obstacle = off ?? (fault || wrongTags || undefined)

  function save(): void {
    setMessage('')
    teach.save({ id: capture.id, name, form, tags: tagsOf(tags), replace: present.exists, by: 'the dashboard', reason }).then(
      () => {
        setProblem('')
        setMessage(`Saved as ${form} ${name}.`)
        setName('')
      },
      (error: unknown) => setProblem(wordsOf(error)),
    )
  }

  return (
    <Paper
      component="form"
      withBorder
      bg="transparent"
      p="sm"
      aria-label={`Save capture ${capture.id}`}
      onSubmit={(event) => {
        event.preventDefault()
        // What overwrites is pressed, not entered.
        if (obstacle === undefined && !present.exists) save()
      }}
    >
      <Stack gap="xs">
        <SimpleGrid minColWidth="13em" spacing="sm" verticalSpacing="xs">
          <TextInput
            size="xs"
            label="Name"
            placeholder="above_tray"
            value={name}
            onChange={(event) => setName(event.currentTarget.value)}
            error={name !== '' && fault}
            autoComplete="off"
            spellCheck={false}
          />
          <NativeSelect
            size="xs"
            label="As"
            value={form}
            onChange={(event) => setForm(event.currentTarget.value as Form)}
            data={formsOf(capture).map((value) => ({ value, label: FORM_WORDS[value] }))}
          />
          <TextInput
            size="xs"
            label="Tags"
            placeholder="station_1, tested"
            value={tags}
            onChange={(event) => setTags(event.currentTarget.value)}
            error={wrongTags}
            autoComplete="off"
            spellCheck={false}
          />
          <TextInput
            size="xs"
            label="Why"
            placeholder="more room"
            value={reason}
            maxLength={1000}
            onChange={(event) => setReason(event.currentTarget.value)}
            autoComplete="off"
          />
        </SimpleGrid>
        {present.exists && (
          <Alert color="yellow" bg="var(--stopped-soft)" p="xs" role="status" aria-label="Effect of overwriting">
            <strong>
              {form} {name} is there already.
            </strong>{' '}
            Behaviors that use it move differently from their next run on; its history keeps the old value.
            {changes.length > 0 && (
              <List size="sm" mt={4}>
                {changes.map((each) => (
                  <List.Item key={each}>{each}</List.Item>
                ))}
              </List>
            )}
          </Alert>
        )}
        {/* Without it the key Enter in a field does nothing. */}
        <input type="submit" hidden />
        <Group gap="xs">
          <CommandButton
            label={present.exists ? 'Overwrite' : 'Save'}
            tone={present.exists ? 'danger' : 'strong'}
            icon={<IconDeviceFloppy size={15} aria-hidden />}
            obstacle={obstacle}
            onPress={save}
          />
          <Text span size="sm" c="dimmed" role="status" aria-label="Saving">
            {message}
          </Text>
        </Group>
        <Refusal>{problem}</Refusal>
      </Stack>
    </Paper>
  )
}

/** What a capture is in a form. */
function asForm(fit: PrimitiveComparison, form: Form): Trace {
  const course = (form === 'trajectory' ? fit.demonstration : (fit.primitive ?? fit.demonstration)) ?? EMPTY
  return form === 'joints' || form === 'pose' ? endOf(fit.demonstration ?? course) : course
}

const EMPTY: Trace = { times_s: [], joint_names: [], joints: [], poses: [], remark: '' }

/** Whether there is an entry of this name, and where the arm is along it. */
function usePresent(arm: string, form: Form, name: string): { readonly exists: boolean; readonly trace: Trace | undefined } {
  const [typed] = useDebouncedValue(name, TYPING_MS)
  const isAsked = name !== '' && typed === name
  const { value: page } = useAnswer({ ...entryQueries.found(form, name), enabled: isAsked })
  const exists = isAsked && (page?.entries.some((each) => each.kind === form && each.name === name) ?? false)
  const { value: fits } = useAnswer({ ...entryQueries.fits(arm, { kind: form, name, capture: 0 }), enabled: exists })
  return { exists, trace: exists ? (fits?.primitive ?? fits?.demonstration ?? undefined) : undefined }
}
