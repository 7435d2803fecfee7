/** What can be done with the chosen nodes, above them; and the field for a new name. */
import { NodeToolbar, Position } from '@xyflow/react'
import {
  IconArrowsDiagonal,
  IconArrowsDiagonalMinimize,
  IconBoxMultiple,
  IconCopyPlus,
  IconCursorText,
  IconExternalLink,
  IconLogin2,
  IconNote,
  IconPlayerTrackNext,
  IconPlugConnected,
  IconPlus,
  IconTrash,
} from '@tabler/icons-react'
import { useEffect, useRef, useState, type ReactNode } from 'react'
import { isFrame, isTreePart, nameProblem, nodeOf, ROOT, type EditNode } from '../../document/editing/model'
import { enclosingReference } from '../../document/editing/referenceInlining'
import { nameOfPath, parentPath } from '../../document/path'
import { duplicate, enter, focusNode, group, remove, rename, toggleOpen } from './actions'
import { toggleDisabled } from './disabled'
import { openAddPalette, openConnectPalette } from './paletteRequests'
import { openReferred } from './pageActions'
import { writeNote } from './notes'
import { toggleReference } from './references'
import { editor, isOpenNow, rootOf, setEditor, useEditor } from './store'

export function SelectionBar() {
  const selection = useEditor((s) => s.selection)
  const renaming = useEditor((s) => s.renaming)
  const node = useEditor((s) => nodeOf(rootOf(s), s.selection.at(-1) ?? ''))
  const root = useEditor(rootOf)
  const foreign = root && node && enclosingReference(root, node.path)
  if (renaming !== undefined) {
    return (
      <NodeToolbar nodeId={renaming} isVisible position={Position.Top} offset={8}>
        <RenameField key={renaming} path={renaming} />
      </NodeToolbar>
    )
  }
  if (!node || selection.length === 0) return null
  if (foreign?.reference.document) {
    const { reference, inner } = foreign
    return (
      <NodeToolbar nodeId={[...selection]} isVisible position={Position.Top} offset={10}>
        <div className="selection-bar" role="toolbar" aria-label="Chosen nodes">
          <Act
            label={`Open ${nameOfPath(reference.document ?? '')} at this node`}
            onPress={() => openReferred(reference.document ?? '', reference.path, inner)}
          >
            <IconExternalLink size={16} />
          </Act>
        </div>
      </NodeToolbar>
    )
  }
  return (
    <NodeToolbar nodeId={[...selection]} isVisible position={Position.Top} offset={10}>
      <div className="selection-bar" role="toolbar" aria-label="Chosen nodes">
        {selection.length === 1 ? <One node={node} /> : <Several count={selection.length} />}
        {node.path !== ROOT && (
          <Act label={`${node.disabled === false ? 'Disable' : 'Enable'} (X)`} onPress={() => void toggleDisabled()}>
            <IconPlayerTrackNext size={16} />
          </Act>
        )}
        <Act label="Duplicate (Ctrl+D)" onPress={() => void duplicate()}>
          <IconCopyPlus size={16} />
        </Act>
        <Act label="Delete (Del)" onPress={() => void remove()}>
          <IconTrash size={16} />
        </Act>
      </div>
    </NodeToolbar>
  )
}

function One({ node }: { node: EditNode }) {
  const isOpen = useEditor((s) => isOpenNow(s, node.path) && (node.document === null || node.children.length > 0))
  const reference = node.document
  return (
    <>
      <Act label="Add a state or container here (A)" onPress={() => openAddPalette()}>
        <IconPlus size={16} />
      </Act>
      <Act label="Connect (C)" onPress={openConnectPalette}>
        <IconPlugConnected size={16} />
      </Act>
      {reference !== null && (
        <>
          <Act label={isOpen ? 'Close it (O)' : 'Show the contents here (O)'} onPress={() => void toggleReference(node.path)}>
            {isOpen ? <IconArrowsDiagonalMinimize size={16} /> : <IconArrowsDiagonal size={16} />}
          </Act>
          <Act label={`Open ${nameOfPath(reference)} in its own page (Enter)`} onPress={() => openReferred(reference, node.path)}>
            <IconExternalLink size={16} />
          </Act>
        </>
      )}
      {reference === null && (isFrame(node) || (isTreePart(node.kind) && node.children.length > 0)) && (
        <>
          <Act label={isOpen ? 'Close it (O)' : 'Open it in place (O)'} onPress={() => toggleOpen(node.path, isOpen)}>
            {isOpen ? <IconArrowsDiagonalMinimize size={16} /> : <IconArrowsDiagonal size={16} />}
          </Act>
          <Act label="Go into it (Enter)" onPress={() => enter(node.path)}>
            <IconLogin2 size={16} />
          </Act>
        </>
      )}
      <Act label="Note (N)" onPress={() => writeNote(node.path)}>
        <IconNote size={16} />
      </Act>
      <Act label="Rename (F2)" onPress={() => setEditor({ renaming: node.path })}>
        <IconCursorText size={16} />
      </Act>
    </>
  )
}

function Several({ count }: { count: number }) {
  return (
    <>
      <span className="selection-count">{count} chosen</span>
      <Act label="Group into a machine (Ctrl+G)" onPress={() => void group('machine')}>
        <IconBoxMultiple size={16} />
      </Act>
    </>
  )
}

function Act({ label, onPress, children }: { label: string; onPress: () => void; children: ReactNode }) {
  return (
    <button type="button" className="bar-button" aria-label={label} title={label} onClick={onPress}>
      {children}
    </button>
  )
}

function RenameField({ path }: { path: string }) {
  const present = nameOfPath(path)
  const [name, setName] = useState(present)
  const field = useRef<HTMLInputElement>(null)
  const parent = nodeOf(rootOf(editor()), parentPath(path))
  const problem = nameProblem(parent, name, present)
  useEffect(() => {
    field.current?.focus()
    field.current?.select()
  }, [])
  const cancel = () => {
    setEditor({ renaming: undefined })
    focusNode(path)
  }
  return (
    <form
      className="rename"
      onSubmit={(event) => {
        event.preventDefault()
        if (!problem) void rename(path, name)
      }}
    >
      <input
        ref={field}
        className="plain-input"
        aria-label={`New name of ${present}`}
        aria-invalid={problem !== undefined}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
        onKeyDown={(event) => event.key === 'Escape' && cancel()}
        onBlur={() => (problem ? cancel() : void rename(path, name))}
      />
      {problem && (
        <span className="rename-problem" role="alert">
          {problem}
        </span>
      )}
    </form>
  )
}
