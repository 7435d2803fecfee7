/** Making a new behavior: its name, where its file goes, and what it begins as. */
import { IconPlus } from '@tabler/icons-react'
import { useMutation } from '@tanstack/react-query'
import { useState } from 'react'
import { wordsOf } from '../../api/client'
import { documents } from '../../api/documents'
import { problemOf, useAnswer } from '../../api/queryClient'
import { relationQueries, relations } from '../../api/relations'
import { Dialog } from '../../components/Dialog'
import { wallTime } from '../../document/time'

const TEMPLATES = [
  { value: 'machine', words: 'State machine: one state after the other' },
  { value: 'sequence', words: 'Behavior tree, beginning with a sequence' },
  { value: 'concurrency', words: 'Several things side by side' },
]

export function NewBehavior({ onMade }: { onMade: (id: string) => void }) {
  const [isOpen, setOpen] = useState(false)
  return (
    <>
      <button type="button" className="command is-quiet new-behavior" onClick={() => setOpen(true)}>
        <IconPlus size={14} aria-hidden /> New
      </button>
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
    <form
      className="new-form"
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
      <label>
        Name
        <input className="new-input" ref={first} value={name} onChange={(event) => setName(event.currentTarget.value)} />
      </label>
      <label>
        Folder, if any
        <input className="new-input" value={folder} onChange={(event) => setFolder(event.currentTarget.value)} />
      </label>
      <label>
        Begins as
        <select className="new-input" value={template} onChange={(event) => setTemplate(event.currentTarget.value)}>
          {TEMPLATES.map((each) => (
            <option key={each.value} value={each.value}>
              {each.words}
            </option>
          ))}
        </select>
      </label>
      <p className="quiet mono new-id">{id}</p>
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      <button type="submit" className="command is-strong">
        Create
      </button>
    </form>
  )
}

/** Behaviors that were deleted and of which a version is kept. */
function Deleted({ onRestored }: { onRestored: (id: string) => void }) {
  const { value: all = [], problem: unread } = useAnswer(relationQueries.deleted())
  const restoring = useMutation({ mutationFn: relations.restore, onSuccess: (made) => onRestored(made.id) })
  const problem = problemOf(restoring.error) ?? unread
  if (problem === undefined && all.length === 0) return null
  return (
    <details className="deleted">
      <summary>Deleted behaviors</summary>
      {problem && (
        <p className="is-failed" role="alert">
          {problem}
        </p>
      )}
      <ul className="plain-list">
        {all.map((each) => (
          <li key={each.id}>
            <span>
              <span className="mono">{each.id.replace(/^behaviors\//, '')}</span>{' '}
              <span className="quiet">last version {wallTime(each.saved_at)}</span>
            </span>
            <button type="button" className="command" onClick={() => restoring.mutate(each.id)}>
              Restore
            </button>
          </li>
        ))}
      </ul>
    </details>
  )
}
