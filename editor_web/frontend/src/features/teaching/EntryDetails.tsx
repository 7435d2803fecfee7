/** One named entry: shown, played back, undone, tagged; and what it was. */
import { Group, Text, TextInput } from '@mantine/core'
import { IconArrowBackUp, IconEye, IconTag, IconTrash } from '@tabler/icons-react'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { previewTaught, teach, useDisabledReason, useTeach } from '../../api/teaching'
import type { EntryChanged } from '../../api/types'
import { CommandButton } from '../../components/CommandButton'
import { tagFault, tagsOf } from '../../document/teaching'
import { EntryHistory } from './EntryHistory'
import { PLAYED } from './forms'
import { Part } from './Part'
import { PlayBack } from './PlayBack'
import { Refusal } from '../../components/Refusal'

export function EntryDetails({ arm, entry }: { readonly arm: string; readonly entry: EntryChanged }) {
  const off = useDisabledReason()
  const looked = useTeach((s) => s.refused.look)
  const [problem, setProblem] = useState('')
  const { kind, name } = entry
  const what = { kind, name, capture: 0 }
  const look = () => previewTaught(arm, what)

  function attempt(work: () => Promise<unknown>): void {
    work().then(
      () => setProblem(''),
      (error: unknown) => setProblem(wordsOf(error)),
    )
  }

  return (
    <Part
      label={`Entry ${kind} ${name}`}
      title={
        <>
          {name}{' '}
          <Text span inherit c="dimmed">
            {kind}
          </Text>
        </>
      }
    >
      <Group gap={6}>
        {PLAYED.has(kind) && <CommandButton label="Show in the cell" icon={<IconEye size={15} aria-hidden />} onPress={look} />}
        <CommandButton
          label="Undo"
          hint="Restore the value before the last change"
          icon={<IconArrowBackUp size={15} aria-hidden />}
          obstacle={off}
          onPress={() => attempt(() => teach.undo(kind, name))}
        />
        <CommandButton
          label="Delete"
          hint="Undo brings it back"
          tone="quiet"
          icon={<IconTrash size={15} aria-hidden />}
          obstacle={off}
          onPress={() => attempt(() => teach.remove(kind, name))}
        />
      </Group>
      <Refusal>{problem || looked?.message}</Refusal>
      {PLAYED.has(kind) && <PlayBack arm={arm} what={what} words={`${kind} ${name}`} onLook={look} />}
      <Tags
        key={entry.revision}
        entry={entry}
        obstacle={off}
        onKeep={(tags) => attempt(() => teach.tag({ kind, name, tags, revision: entry.revision }))}
      />
      <EntryHistory arm={arm} entry={entry} />
    </Part>
  )
}

interface TagsProps {
  readonly entry: EntryChanged
  readonly obstacle: string | undefined
  readonly onKeep: (tags: readonly string[]) => void
}

function Tags({ entry, obstacle, onKeep }: TagsProps) {
  const before = entry.tags.join(', ')
  const [typed, setTyped] = useState(before)
  const fault = tagFault(typed)
  const isSame = tagsOf(typed).toSorted().join() === entry.tags.toSorted().join()
  const off = obstacle ?? (fault || (isSame ? 'they are as they were' : undefined))
  return (
    <form
      aria-label={`Tags of ${entry.name}`}
      onSubmit={(event) => {
        event.preventDefault()
        if (off === undefined) onKeep(tagsOf(typed))
      }}
    >
      <Group align="flex-end" wrap="nowrap" gap="xs">
        <TextInput
          flex={1}
          size="xs"
          label="Tags"
          placeholder="station_1, tested"
          value={typed}
          error={fault}
          onChange={(event) => setTyped(event.currentTarget.value)}
          autoComplete="off"
          spellCheck={false}
        />
        <CommandButton label="Save tags" icon={<IconTag size={15} aria-hidden />} obstacle={off} onPress={() => onKeep(tagsOf(typed))} />
      </Group>
    </form>
  )
}
