/** Giving the file of a behavior another name, copying it, deleting it; who refers to it is shown before. */
import { Box, Button, Checkbox, Code, Group, Stack, Text, TextInput } from '@mantine/core'
import { useEffect, useState, type ReactNode } from 'react'
import { Refusal } from '../../components/Refusal'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { relationQueries, relations } from '../../api/relations'
import type { ReferringBehavior } from '../../api/types'
import { Dialog } from '../../components/Dialog'
import { fileProblem, idOfFile, partsOfId } from '../../document/editing/fileNames'
import { FormWords } from './FormParts'
import { openOther } from './pageActions'
import { closeFileDialog, useFileDialog, type FileDialog } from './fileDialogs'
import { deleteStoredDraft } from './draftStorage'
import { save } from './session'
import { editor, isDirty, showEditorRefusal, showEditorNotice, useEditor } from './store'

export function FileDialogs({ onGone }: { onGone: () => void }) {
  const open = useFileDialog((s) => s.open)
  const id = useEditor((s) => s.id)
  useEffect(() => closeFileDialog, [])
  if (open === undefined || open === 'versions') return null
  return (
    <Dialog isOpen onClose={closeFileDialog} title={TITLES[open]}>
      {open === 'delete' ? <DeleteForm id={id} onGone={onGone} /> : <NameForm id={id} kind={open} />}
    </Dialog>
  )
}

const TITLES: Readonly<Record<Exclude<FileDialog, 'versions'>, string>> = {
  rename: 'Rename or move',
  duplicate: 'Duplicate',
  delete: 'Delete',
}

/** Who refers to a document; undefined until it is known. */
function useReferrers(id: string): readonly ReferringBehavior[] | undefined {
  const { value, problem } = useAnswer(relationQueries.referrers(id))
  useEffect(() => {
    if (problem !== undefined) showEditorRefusal('References', problem)
  }, [problem])
  return value
}

function Referrers({ all, children }: { all: readonly ReferringBehavior[] | undefined; children: ReactNode }) {
  if (all === undefined) return <FormWords>Looking who refers to it …</FormWords>
  if (all.length === 0) return <FormWords>No other behavior refers to it.</FormWords>
  return (
    <Box px="sm" py="xs" bg="var(--stopped-soft)" fz="sm" style={{ borderRadius: 'var(--mantine-radius-md)', overflowWrap: 'anywhere' }}>
      {children}
      <Box component="ul" m={0} pl="md">
        {all.map((each) => (
          <li key={each.id}>
            <Code bg="none">{each.id}</Code> {each.paths.map((path) => path.replace(/^root\//, '')).join(', ')}
          </li>
        ))}
      </Box>
    </Box>
  )
}

/** The browser puts the keyboard there when the dialog opens; React would do so too early. */
function first(field: HTMLElement | null): void {
  field?.setAttribute('autofocus', '')
}

function NameForm({ id, kind }: { id: string; kind: 'rename' | 'duplicate' }) {
  const present = partsOfId(id)
  const referrers = useReferrers(id)
  const [name, setName] = useState(kind === 'duplicate' ? `${present.name}_copy` : present.name)
  const [folder, setFolder] = useState(present.folder)
  const [follows, setFollows] = useState(true)
  const [refusal, setRefusal] = useState<string>()
  const dirty = useEditor(isDirty)
  const to = idOfFile(folder, name, present.ending)
  const problem = fileProblem(folder, name) ?? (to === id ? 'It is called so already' : undefined)
  const isRename = kind === 'rename'

  async function go(): Promise<void> {
    if (problem) return
    // The file is what is moved or copied: what is not saved would be left behind.
    if (dirty && !(await save())) return
    try {
      if (isRename) {
        const moved = await relations.move(id, to, follows)
        deleteStoredDraft(id)
        closeFileDialog()
        openOther(to)
        showEditorNotice(moved.updated.length > 0 ? `Renamed; ${moved.updated.length} follow` : 'Renamed')
        if (moved.left.length > 0) showEditorRefusal('Rename', `not changed: ${moved.left.join(', ')}`, 'Change them by hand.')
      } else {
        await relations.duplicate(id, to)
        closeFileDialog()
        openOther(to)
      }
    } catch (error) {
      setRefusal(wordsOf(error))
    }
  }

  return (
    <form
      onSubmit={(event) => {
        event.preventDefault()
        void go()
      }}
    >
      <Stack gap="sm" miw="min(24rem, 80vw)">
        <TextInput
          ref={first}
          label="Name of the file"
          value={name}
          error={problem !== undefined && to !== id}
          onChange={(event) => setName(event.currentTarget.value)}
        />
        <TextInput label="Folder, if any" value={folder} onChange={(event) => setFolder(event.currentTarget.value)} />
        <Text size="xs" c="dimmed" ff="monospace" style={{ overflowWrap: 'anywhere' }}>
          {to}
        </Text>
        {isRename && (
          <>
            <Referrers all={referrers}>Behaviors that refer to it:</Referrers>
            {referrers && referrers.length > 0 && (
              <Checkbox
                size="xs"
                label="Let them refer to the new name"
                checked={follows}
                onChange={(event) => setFollows(event.currentTarget.checked)}
              />
            )}
          </>
        )}
        {dirty && <FormWords>Unsaved changes are saved first.</FormWords>}
        <Refusal>{refusal ?? (to === id ? undefined : problem)}</Refusal>
        <Button type="submit" aria-disabled={problem !== undefined}>
          {isRename ? 'Rename' : 'Make the copy'}
        </Button>
      </Stack>
    </form>
  )
}

function DeleteForm({ id, onGone }: { id: string; onGone: () => void }) {
  const referrers = useReferrers(id)
  const [refusal, setRefusal] = useState<string>()
  async function go(): Promise<void> {
    try {
      await relations.remove(id)
      deleteStoredDraft(id)
      closeFileDialog()
      onGone()
    } catch (error) {
      setRefusal(wordsOf(error))
    }
  }
  return (
    <Stack gap="sm" miw="min(24rem, 80vw)">
      <Text size="sm">
        <Code bg="none" p={0}>
          {id}
        </Code>{' '}
        goes from the disk. Its versions stay: it can be restored with <em>New</em>, <em>Deleted behaviors</em>.
      </Text>
      <Referrers all={referrers}>These refer to it and cannot run without it:</Referrers>
      {isDirty(editor()) && (
        <Text size="sm" c="var(--failed)">
          Unsaved changes are lost.
        </Text>
      )}
      <Refusal>{refusal}</Refusal>
      <Group gap="xs">
        <Button variant="default" c="var(--failed)" bd="1px solid var(--failed)" onClick={() => void go()}>
          Delete {partsOfId(id).name}
        </Button>
        <Button variant="subtle" color="gray" c="dimmed" ref={first} onClick={closeFileDialog}>
          Keep it
        </Button>
      </Group>
    </Stack>
  )
}
