/** Giving the file of a behavior another name, copying it, deleting it; who refers to it is shown before. */
import { useEffect, useState, type ReactNode } from 'react'
import { wordsOf } from '../../api/client'
import { useAnswer } from '../../api/queryClient'
import { relationQueries, relations } from '../../api/relations'
import type { ReferringBehavior } from '../../api/types'
import { Dialog } from '../../components/Dialog'
import { fileProblem, idOfFile, partsOfId } from '../../document/editing/fileNames'
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
  if (all === undefined) return <p className="quiet">Looking who refers to it …</p>
  if (all.length === 0) return <p className="quiet">No other behavior refers to it.</p>
  return (
    <div className="referrers">
      <p>{children}</p>
      <ul>
        {all.map((each) => (
          <li key={each.id}>
            <span className="mono">{each.id}</span>{' '}
            <span className="quiet">{each.paths.map((path) => path.replace(/^root\//, '')).join(', ')}</span>
          </li>
        ))}
      </ul>
    </div>
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
      className="new-form file-form"
      onSubmit={(event) => {
        event.preventDefault()
        void go()
      }}
    >
      <label>
        Name of the file
        <input
          ref={first}
          className="new-input"
          value={name}
          aria-invalid={problem !== undefined}
          onChange={(event) => setName(event.currentTarget.value)}
        />
      </label>
      <label>
        Folder, if any
        <input className="new-input" value={folder} onChange={(event) => setFolder(event.currentTarget.value)} />
      </label>
      <p className="quiet mono new-id">{to}</p>
      {isRename && (
        <>
          <Referrers all={referrers}>Behaviors that refer to it:</Referrers>
          {referrers && referrers.length > 0 && (
            <label className="check-line">
              <input type="checkbox" checked={follows} onChange={(event) => setFollows(event.currentTarget.checked)} />
              Let them refer to the new name
            </label>
          )}
        </>
      )}
      {dirty && <p className="quiet">Unsaved changes are saved first.</p>}
      {(refusal ?? (to === id ? undefined : problem)) && (
        <p className="is-failed" role="alert">
          {refusal ?? problem}
        </p>
      )}
      <button type="submit" className="command is-strong" aria-disabled={problem !== undefined}>
        {isRename ? 'Rename' : 'Make the copy'}
      </button>
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
    <div className="new-form file-form">
      <p>
        <span className="mono">{id}</span> goes from the disk. Its versions stay: it can be restored with <em>New</em>,{' '}
        <em>Deleted behaviors</em>.
      </p>
      <Referrers all={referrers}>These refer to it and cannot run without it:</Referrers>
      {isDirty(editor()) && <p className="is-failed">Unsaved changes are lost.</p>}
      {refusal && (
        <p className="is-failed" role="alert">
          {refusal}
        </p>
      )}
      <div className="command-row">
        <button type="button" className="command is-danger" onClick={() => void go()}>
          Delete {partsOfId(id).name}
        </button>
        <button type="button" className="command is-quiet" ref={first} onClick={closeFileDialog}>
          Keep it
        </button>
      </div>
    </div>
  )
}
