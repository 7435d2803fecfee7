/** The versions of a behavior: when and by what each was written, what differs between two, one of them restored. */
import { Button, Group, Input, Loader, NativeSelect, Space, Stack, Text, UnstyledButton } from '@mantine/core'
import { queryOptions, skipToken } from '@tanstack/react-query'
import { useId, useMemo, useState } from 'react'
import { Refusal } from '../../components/Refusal'
import { useLive } from '../../api/live'
import { useAnswer, type Answer } from '../../api/queryClient'
import { queryKeys } from '../../api/queryKeys'
import { relationQueries, relations } from '../../api/relations'
import type { DocumentDiff, VersionBody } from '../../api/types'
import { Dialog } from '../../components/Dialog'
import type { EditNode } from '../../document/editing/model'
import { wallTime } from '../../document/time'
import { takeText } from './apply'
import { closeFileDialog, useFileDialog } from './fileDialogs'
import { PlainList } from './PlainList'
import rows from './row.module.css'
import { draftOf, editor, isDirty, rootOf, showEditorNotice, useEditor } from './store'
import classes from './versions.module.css'
import { VersionView, type Shown } from './VersionView'

/** The text that is being edited, among the versions. */
const DRAFT = 'draft'

export function VersionsDialog() {
  const isOpen = useFileDialog((s) => s.open === 'versions')
  if (!isOpen) return null
  return (
    <Dialog isOpen onClose={closeFileDialog} title="Versions">
      <Versions />
    </Dialog>
  )
}

function Versions() {
  const id = useEditor((s) => s.id)
  const dirty = useEditor(isDirty)
  const choice = useId()
  const mayEdit = useLive((s) => s.role === 'operator')
  const { value: versions, problem: unread } = useAnswer(relationQueries.versions(id))
  const [startsWithDraft] = useState(dirty)
  const [chosen, setShown] = useState<string>()
  const [against, setAgainst] = useState<string>()
  const shown = chosen ?? (startsWithDraft ? DRAFT : versions?.[0]?.hash)

  const order = useMemo(() => [...(dirty ? [DRAFT] : []), ...(versions ?? []).map((version) => version.hash)], [dirty, versions])
  const before = against ?? order[order.indexOf(shown ?? '') + 1]
  const { value: compared, problem: different } = useCompared(id, before, versions && shown)
  const problem = unread ?? different

  async function restore(): Promise<void> {
    const text = compared?.after.text
    if (text === undefined || shown === undefined) return
    const version = versions?.find((each) => each.hash === shown)
    closeFileDialog()
    await takeText(`Restore the version of ${wallTime(version?.saved_at ?? 0)}`, text)
    showEditorNotice('Restored; save it to keep it')
  }

  if (problem) {
    return <Refusal>{problem}</Refusal>
  }
  if (!versions) return <Loader size="sm" m="auto" role="status" aria-label="Loading" />
  return (
    <div className={`${classes['versions']} ${classes['wide']}`}>
      <div>
        <PlainList label="Versions, newest first">
          {order.map((hash) => {
            const version = versions.find((each) => each.hash === hash)
            return (
              <li key={hash}>
                <UnstyledButton
                  className={`${rows['row']} pick-row`}
                  style={{ flexDirection: 'column', gap: 0 }}
                  aria-current={hash === shown ? 'true' : undefined}
                  onClick={() => {
                    setShown(hash)
                    setAgainst(undefined)
                  }}
                >
                  <strong>{version ? wallTime(version.saved_at) : 'Draft, not saved'}</strong>
                  <Text span size="xs" c="dimmed">
                    {version && (version.by === 'editor' ? 'saved here' : 'found in the file')}
                    {version?.current && ' · on disk now'}
                  </Text>
                </UnstyledButton>
              </li>
            )
          })}
        </PlainList>
      </div>
      <Stack gap={8}>
        <Group gap="xs" fz="sm">
          <Input.Label htmlFor={choice} size="sm">
            Compare with
          </Input.Label>
          <NativeSelect
            id={choice}
            size="xs"
            value={before ?? ''}
            data={[
              ...(before === undefined ? [{ value: '', label: 'nothing older' }] : []),
              ...order.filter((hash) => hash !== shown).map((hash) => ({ value: hash, label: optionWords(versions, hash) })),
            ]}
            onChange={(event) => setAgainst(event.currentTarget.value || undefined)}
          />
          <Space flex={1} />
          {mayEdit && shown !== DRAFT && (
            <Button
              size="compact-sm"
              disabled={!compared || compared.after.text === draftOf(editor()).text}
              title="Takes its text into the draft; undo takes it back, save writes it"
              onClick={() => void restore()}
            >
              Restore this version
            </Button>
          )}
        </Group>
        {compared ? (
          <VersionView key={`${before} ${shown}`} {...compared} />
        ) : (
          <Loader size="sm" m="auto" role="status" aria-label="Loading" />
        )}
      </Stack>
    </div>
  )
}

function optionWords(versions: readonly VersionBody[], hash: string): string {
  const version = versions.find((each) => each.hash === hash)
  return version ? `${wallTime(version.saved_at)}${version.current ? ', on disk now' : ''}` : 'the draft'
}

interface Compared {
  readonly before: Shown | undefined
  readonly after: Shown
  readonly difference: DocumentDiff | undefined
}

/** Both texts with what they draw, and what differs; undefined until they are there. */
function useCompared(id: string, before: string | undefined, after: string | undefined): Answer<Compared> {
  const draft = useEditor((s) => ([before, after].includes(DRAFT) ? draftOf(s).text : ''))
  return useAnswer(
    queryOptions({
      queryKey: queryKeys.comparedVersions(id, before, after, draft),
      queryFn: after === undefined ? skipToken : () => compare(id, before, after),
      // What is drawn is known by its identity.
      structuralSharing: false,
      gcTime: 0,
    }),
  )
}

async function compare(id: string, before: string | undefined, after: string): Promise<Compared> {
  const [old, now] = await Promise.all([before === undefined ? undefined : load(id, before), load(id, after)])
  if (!old || before === undefined) return { before: undefined, after: now, difference: undefined }
  // A text with mistakes is shown, and compared line by line only.
  const isReadable = old.root !== undefined && now.root !== undefined
  const asked = [before, after].includes(DRAFT)
    ? () => relations.compare(id, old.text, now.text)
    : () => relations.difference(id, before, after)
  return { before: old, after: now, difference: isReadable ? await asked() : undefined }
}

async function load(id: string, hash: string): Promise<Shown> {
  if (hash === DRAFT) {
    const { text, document, isStale } = draftOf(editor())
    const root = isStale ? undefined : rootOf(editor())
    return { text, root, outcomes: document?.outcomes ?? [], words: 'Draft' }
  }
  const [{ text, saved_at }, drawn] = await Promise.all([relations.version(id, hash), relations.drawn(id, hash)])
  const root: EditNode | undefined = drawn.graph ?? undefined
  return { text, root, outcomes: drawn.document?.outcomes ?? [], words: wallTime(saved_at) }
}
