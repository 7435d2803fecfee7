/** Notes as slips of paper on the canvas, at the nodes they are about; written in place. */
import { Box, UnstyledButton } from '@mantine/core'
import { Panel, useNodes, ViewportPortal } from '@xyflow/react'
import { useMemo } from 'react'
import { allNodes, isForeign, ROOT } from '../../document/editing/model'
import { nameOfPath } from '../../document/path'
import { focusNode } from './actions'
import classes from './canvas.module.css'
import type { CanvasNode } from './elements'
import { nodeBoxes } from './nodeBoxes'
import { dropNote, keepNote, useNotes, writeNote } from './notes'
import { rootOf, scopeOf, useEditor } from './store'

const SLIP_PX = 168
const OVER = { position: 'absolute', top: 0, left: 0, zIndex: 6, pointerEvents: 'all' } as const
const SCOPE_SLIP_PX = 220
const WRITTEN_SLIP_PX = 210

/** A slip of paper. */
const SLIP = {
  px: 9,
  py: 6,
  bg: 'var(--paper)',
  c: 'var(--ink)',
  bd: '1px solid var(--paper-edge)',
  bdrs: '3px 3px 10px',
  fz: 12,
  lh: 1.35,
  style: {
    display: 'block',
    overflow: 'hidden',
    boxShadow: 'var(--mantine-shadow-sm)',
    overflowWrap: 'anywhere',
    resize: 'none',
    whiteSpace: 'pre-line',
  },
} as const

export function NoteOverlay() {
  const isShown = useNotes((s) => s.isShown)
  const writing = useNotes((s) => s.writing)
  const scope = useEditor(scopeOf)
  if (!isShown || !scope) return null
  return (
    <>
      {(scope.notes || writing === scope.path) && (
        <Panel position="top-left">
          <Note path={scope.path} text={scope.notes} width={SCOPE_SLIP_PX} />
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
          <div key={node.path} style={{ ...OVER, transform: `translate(${at.x}px, ${at.y}px) translateY(-100%)` }}>
            <Note path={node.path} text={node.notes} width={SLIP_PX} />
          </div>
        )
      })}
    </ViewportPortal>
  )
}

function Note({ path, text, width }: { path: string; text: string; width: number }) {
  const isWriting = useNotes((s) => s.writing === path)
  const isOfOther = useEditor((s) => {
    const root = rootOf(s)
    return root !== undefined && isForeign(root, path)
  })
  const name = path === ROOT ? 'the behavior' : nameOfPath(path)
  if (!isWriting) {
    return (
      <UnstyledButton
        {...SLIP}
        className="nodrag nopan"
        w={width}
        mah={96}
        disabled={isOfOther}
        aria-label={`Note on ${name}: ${text}`}
        title="Change it (N)"
        onClick={() => writeNote(path)}
      >
        {text}
      </UnstyledButton>
    )
  }
  return (
    <Box
      component="textarea"
      {...SLIP}
      className={`${classes['slip']} nodrag nopan nowheel`}
      w={Math.max(width, WRITTEN_SLIP_PX)}
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
