/** The versions of a behavior: when and by what each was written, what differs between two, one of them restored. */
import { queryOptions, skipToken } from '@tanstack/react-query'
import { useMemo, useState } from 'react'
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
import { draftOf, editor, isDirty, rootOf, showEditorNotice, useEditor } from './store'
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
    return (
      <p className="is-failed" role="alert">
        {problem}
      </p>
    )
  }
  if (!versions) return <div className="page-wait" role="status" aria-label="Loading" />
  return (
    <div className="versions">
      <div className="version-list">
        <ul className="plain-list" aria-label="Versions, newest first">
          {order.map((hash) => {
            const version = versions.find((each) => each.hash === hash)
            return (
              <li key={hash}>
                <button
                  type="button"
                  className="version"
                  aria-current={hash === shown ? 'true' : undefined}
                  onClick={() => {
                    setShown(hash)
                    setAgainst(undefined)
                  }}
                >
                  <strong>{version ? wallTime(version.saved_at) : 'Draft, not saved'}</strong>
                  <span className="quiet">
                    {version && (version.by === 'editor' ? 'saved here' : 'found in the file')}
                    {version?.current && ' · on disk now'}
                  </span>
                </button>
              </li>
            )
          })}
        </ul>
      </div>
      <div className="version-body">
        <div className="version-head">
          <label>
            Compare with{' '}
            <select className="plain-input" value={before ?? ''} onChange={(event) => setAgainst(event.currentTarget.value || undefined)}>
              {before === undefined && <option value="">nothing older</option>}
              {order
                .filter((hash) => hash !== shown)
                .map((hash) => (
                  <option key={hash} value={hash}>
                    {optionWords(versions, hash)}
                  </option>
                ))}
            </select>
          </label>
          <span className="spacer" />
          {mayEdit && shown !== DRAFT && (
            <button
              type="button"
              className="command is-strong"
              disabled={!compared || compared.after.text === draftOf(editor()).text}
              title="Takes its text into the draft; undo takes it back, save writes it"
              onClick={() => void restore()}
            >
              Restore this version
            </button>
          )}
        </div>
        {compared ? (
          <VersionView key={`${before} ${shown}`} {...compared} />
        ) : (
          <div className="page-wait" role="status" aria-label="Loading" />
        )}
      </div>
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
