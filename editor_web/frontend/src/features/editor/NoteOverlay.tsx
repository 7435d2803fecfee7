/** Notes as slips of paper on the canvas, at the nodes they are about; written in place. */
import { Panel, useNodes, ViewportPortal } from '@xyflow/react'
import { useMemo } from 'react'
import { allNodes, isForeign, ROOT } from '../../document/editing/model'
import { nameOfPath } from '../../document/path'
import { focusNode } from './actions'
import type { CanvasNode } from './elements'
import { nodeBoxes } from './nodeBoxes'
import { dropNote, keepNote, useNotes, writeNote } from './notes'
import { rootOf, scopeOf, useEditor } from './store'

const SLIP_PX = 168

export function NoteOverlay() {
  const isShown = useNotes((s) => s.isShown)
  const writing = useNotes((s) => s.writing)
  const scope = useEditor(scopeOf)
  if (!isShown || !scope) return null
  return (
    <>
      {(scope.notes || writing === scope.path) && (
        <Panel position="top-left" className="scope-note">
          <Note path={scope.path} text={scope.notes} />
        </Panel>
      )}
      <NodeNotes />
    </>
  )
}

function NodeNotes() {
  const nodes = useNodes<CanvasNode>()
  const root = useEditor(rootOf)
  const writing = useNotes((s) => s.writing)
  const boxes = useMemo(() => nodeBoxes(nodes), [nodes])
  // Nodes move with each frame of a drag, notes do not.
  const noted = useMemo(() => (root ? allNodes(root).filter((node) => node.notes || writing === node.path) : []), [root, writing])
  if (noted.length === 0) return null
  return (
    <ViewportPortal>
      {noted.map((node) => {
        const box = boxes.get(node.path)
        if (!box) return null
        // Above the right end of the node, where it hides neither its name nor a port.
        const at = { x: box.x + box.width - SLIP_PX, y: box.y - 4 }
        return (
          <div key={node.path} className="node-note" style={{ transform: `translate(${at.x}px, ${at.y}px) translateY(-100%)` }}>
            <Note path={node.path} text={node.notes} />
          </div>
        )
      })}
    </ViewportPortal>
  )
}

function Note({ path, text }: { path: string; text: string }) {
  const isWriting = useNotes((s) => s.writing === path)
  const isOfOther = useEditor((s) => {
    const root = rootOf(s)
    return root !== undefined && isForeign(root, path)
  })
  const name = path === ROOT ? 'the behavior' : nameOfPath(path)
  if (!isWriting) {
    return (
      <button
        type="button"
        className="note-slip nodrag nopan"
        disabled={isOfOther}
        aria-label={`Note on ${name}: ${text}`}
        title="Change it (N)"
        onClick={() => writeNote(path)}
      >
        {text}
      </button>
    )
  }
  return (
    <textarea
      className="note-slip nodrag nopan nowheel"
      aria-label={`Note on ${name}`}
      placeholder="Information for editors of the behavior"
      rows={3}
      defaultValue={text}
      ref={(field) => field?.focus({ preventScroll: true })}
      onBlur={(event) => void keepNote(path, event.currentTarget.value)}
      onKeyDown={(event) => {
        if (event.key === 'Escape') {
          event.stopPropagation()
          dropNote()
          focusNode(path)
        }
        if (event.key === 'Enter' && (event.ctrlKey || event.metaKey)) {
          event.stopPropagation()
          event.currentTarget.blur()
          focusNode(path)
        }
      }}
    />
  )
}
