/** Making a new behavior: its name, where its file goes, and what it begins as. */
import { Box, Button, Group, NativeSelect, Stack, Text, TextInput } from '@mantine/core'
import { IconPlus } from '@tabler/icons-react'
import { useMutation } from '@tanstack/react-query'
import { useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import { problemOf, useAnswer } from '../../api/queryClient'
import { relationQueries, relations } from '../../api/relations'
import { Dialog } from '../../components/Dialog'
import { wallTime } from '../../document/time'

const TEMPLATES = [
  { value: 'machine', label: 'State machine: one state after the other' },
  { value: 'sequence', label: 'Behavior tree, beginning with a sequence' },
  { value: 'concurrency', label: 'Several things side by side' },
]

export function NewBehavior({ onMade }: { onMade: (id: string) => void }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <Button
        variant="subtle"
        color="gray"
        size="compact-xs"
        leftSection={<IconPlus size={14} aria-hidden />}
        data-tour="new-behavior"
        onClick={() => setOpen(true)}
      >
        New
      </Button>
      <Dialog isOpen={isOpen} title="New behavior" onClose={() => setOpen(false)}>
        <NewForm
          onMade={(id) => {
            setOpen(false)
            onMade(id)
          }}
        />
        <Deleted
          onRestored={(id) => {
            setOpen(false)
            onMade(id)
          }}
        />
      </Dialog>
    </>
  )
}

/** The browser puts the keyboard there when the dialog opens; React would do so too early. */
function first(field: HTMLInputElement | null): void {
  field?.setAttribute('autofocus', '')
}

function NewForm({ onMade }: { onMade: (id: string) => void }) {
  const [name, setName] = useState('')
  const [folder, setFolder] = useState('')
  const [template, setTemplate] = useState('machine')
  const [problem, setProblem] = useState<string>()
  const file = name.trim().replace(/[^A-Za-z0-9_-]+/g, '_')
  const id = ['behaviors', folder.trim().replace(/^\/+|\/+$/g, ''), `${file || 'name'}.yaml`].filter(Boolean).join('/')
  return (
    <Stack
      component="form"
      gap="sm"
      miw="min(24rem, 80vw)"
      data-tour="new-form"
      onSubmit={(event) => {
        event.preventDefault()
        if (!file) setProblem('It needs a name')
        else
          documents.make({ id, name: name.trim(), template }).then(
            (made) => onMade(made.id),
            (error: unknown) => setProblem(wordsOf(error)),
          )
      }}
    >
      <TextInput label="Name" ref={first} value={name} onChange={(event) => setName(event.currentTarget.value)} />
      <TextInput label="Folder, if any" value={folder} onChange={(event) => setFolder(event.currentTarget.value)} />
      <NativeSelect label="Begins as" data={TEMPLATES} value={template} onChange={(event) => setTemplate(event.currentTarget.value)} />
      <Text size="sm" ff="monospace" c="var(--quiet)" style={{ overflowWrap: 'anywhere' }}>
        {id}
      </Text>
      <Refusal>{problem}</Refusal>
      <Button type="submit">Create</Button>
    </Stack>
  )
}

/** Behaviors that were deleted and of which a version is kept. */
function Deleted({ onRestored }: { onRestored: (id: string) => void }) {
  const { value: all = [], problem: unread } = useAnswer(relationQueries.deleted())
  const restoring = useMutation({ mutationFn: relations.restore, onSuccess: (made) => onRestored(made.id) })
  const problem = problemOf(restoring.error) ?? unread
  if (problem === undefined && all.length === 0) return null
  return (
    <Box component="details" mt="md" fz="sm">
      <Text component="summary" inherit style={{ cursor: 'pointer' }}>
        Deleted behaviors
      </Text>
      <Refusal>{problem}</Refusal>
      <ul className="plain-list">
        {all.map((each) => (
          <Group component="li" key={each.id} justify="space-between" wrap="nowrap" py="4xs" style={{ overflowWrap: 'anywhere' }}>
            <span>
              <Text span inherit ff="monospace">
                {each.id.replace(/^behaviors\//, '')}
              </Text>{' '}
              <Text span inherit c="var(--quiet)">
                last version {wallTime(each.saved_at)}
              </Text>
            </span>
            <Button size="compact-sm" variant="default" onClick={() => restoring.mutate(each.id)}>
              Restore
            </Button>
          </Group>
        ))}
      </ul>
    </Box>
  )
}
