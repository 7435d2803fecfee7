/** The file and the draft have both changed: what each has, side by side, and which text to go on with. */
import { useState } from 'react'
import { Dialog } from '../../components/Dialog'
import { LineDiff } from './LineDiff'
import { resolve, type Side } from './session'
import { draftOf, setEditor, useEditor } from './store'

export function ConflictDialog() {
  const conflict = useEditor((s) => s.conflict)
  const mine = useEditor((s) => draftOf(s).text)
  const [against, setAgainst] = useState<Side>('theirs')
  if (!conflict) return null
  const right = against === 'merged' ? (conflict.merged ?? '') : conflict.theirs
  const isMergeable = conflict.merged !== null
  const close = () => setEditor({ conflict: undefined, isOutdated: true })
  return (
    <Dialog isOpen onClose={close} title="The file has changed on disk">
      <div className="conflict">
        <p>
          {isMergeable
            ? 'Both sides changed different lines; they can be merged.'
            : 'Both sides changed the same lines. Nothing was written; choose which text to go on with.'}
        </p>
        <div className="conflict-heads">
          <strong>Yours</strong>
          <div role="radiogroup" aria-label="Compare with" className="conflict-choice">
            <Against label="On disk" side="theirs" now={against} onChoose={setAgainst} />
            {isMergeable && <Against label="Merged" side="merged" now={against} onChoose={setAgainst} />}
          </div>
        </div>
        <LineDiff label="Differences, yours on the left" left={mine} right={right} />
        <div className="command-row">
          {isMergeable && (
            <button type="button" className="command is-strong" onClick={() => void resolve('merged')}>
              Save the merged text
            </button>
          )}
          <button type="button" className="command" onClick={() => void resolve('theirs')}>
            Take the one on disk
          </button>
          <button type="button" className="command is-danger" onClick={() => void resolve('mine')}>
            Overwrite with yours
          </button>
          <button type="button" className="command is-quiet" onClick={close}>
            Go on editing
          </button>
        </div>
      </div>
    </Dialog>
  )
}

function Against({ label, side, now, onChoose }: { label: string; side: Side; now: Side; onChoose: (side: Side) => void }) {
  return (
    <button
      type="button"
      role="radio"
      aria-checked={side === now}
      className={`command is-quiet${side === now ? ' is-chosen' : ''}`}
      onClick={() => onChoose(side)}
    >
      {label}
    </button>
  )
}
