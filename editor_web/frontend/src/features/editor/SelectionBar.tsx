/** What can be done with the chosen nodes, above them; and the field for a new name. */
import { Group, Paper, Text, TextInput } from '@mantine/core'
import { NodeToolbar, Position } from '@xyflow/react'
import {
  IconArrowsDiagonal,
  IconArrowsDiagonalMinimize,
  IconBoxMultiple,
  IconCopyPlus,
  IconCursorText,
  IconExternalLink,
  IconHierarchy3,
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
import { layOutSelected } from './placing'
import { writeNote } from './notes'
import { toggleReference } from './references'
import { editor, isOpenNow, rootOf, setEditor, useEditor } from './store'
import { Tool } from './Tool'

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
        <Bar>
          <Tool
            label={`Open ${nameOfPath(reference.document ?? '')} at this node`}
            onPress={() => openReferred(reference.document ?? '', reference.path, inner)}
          >
            <IconExternalLink size={16} />
          </Tool>
        </Bar>
      </NodeToolbar>
    )
  }
  return (
    <NodeToolbar nodeId={[...selection]} isVisible position={Position.Top} offset={10}>
      <Bar>
        {selection.length === 1 ? <One node={node} /> : <Several count={selection.length} />}
        {node.path !== ROOT && (
          <Tool label={node.disabled === false ? 'Disable' : 'Enable'} command="disable" onPress={() => void toggleDisabled()}>
            <IconPlayerTrackNext size={16} />
          </Tool>
        )}
        <Tool label="Duplicate" command="duplicate" onPress={() => void duplicate()}>
          <IconCopyPlus size={16} />
        </Tool>
        <Tool label="Delete" command="remove" onPress={() => void remove()}>
          <IconTrash size={16} />
        </Tool>
      </Bar>
    </NodeToolbar>
  )
}

function Bar({ children }: { children: ReactNode }) {
  return (
    <Paper withBorder shadow="md" p={2} role="toolbar" aria-label="Selected nodes">
      <Group gap={0} wrap="nowrap">
        {children}
      </Group>
    </Paper>
  )
}

function One({ node }: { node: EditNode }) {
  const isOpen = useEditor((s) => isOpenNow(s, node.path) && (node.document === null || node.children.length > 0))
  const reference = node.document
  return (
    <>
      <Tool label="Add a state or container here" command="add" onPress={() => openAddPalette()}>
        <IconPlus size={16} />
      </Tool>
      <Tool label="Connect" command="connect" onPress={openConnectPalette}>
        <IconPlugConnected size={16} />
      </Tool>
      {reference !== null && (
        <>
          <Tool label={isOpen ? 'Close it' : 'Show the contents here'} command="open" onPress={() => void toggleReference(node.path)}>
            {isOpen ? <IconArrowsDiagonalMinimize size={16} /> : <IconArrowsDiagonal size={16} />}
          </Tool>
          <Tool label={`Open ${nameOfPath(reference)} in its own page`} command="enter" onPress={() => openReferred(reference, node.path)}>
            <IconExternalLink size={16} />
          </Tool>
        </>
      )}
      {reference === null && (isFrame(node) || (isTreePart(node.kind) && node.children.length > 0)) && (
        <>
          <Tool label={isOpen ? 'Close it' : 'Open it in place'} command="open" onPress={() => toggleOpen(node.path, isOpen)}>
            {isOpen ? <IconArrowsDiagonalMinimize size={16} /> : <IconArrowsDiagonal size={16} />}
          </Tool>
          <Tool label="Go into it" command="enter" onPress={() => enter(node.path)}>
            <IconLogin2 size={16} />
          </Tool>
        </>
      )}
      <Tool label="Note" command="note" onPress={() => writeNote(node.path)}>
        <IconNote size={16} />
      </Tool>
      <Tool label="Rename" command="rename" onPress={() => setEditor({ renaming: node.path })}>
        <IconCursorText size={16} />
      </Tool>
    </>
  )
}

function Several({ count }: { count: number }) {
  return (
    <>
      <Text span size="xs" fw={600} px="xs" style={{ whiteSpace: 'nowrap' }}>
        {count} selected
      </Text>
      <Tool label="Group into a machine" command="group" onPress={() => void group('machine')}>
        <IconBoxMultiple size={16} />
      </Tool>
      <Tool label="Auto-layout of the selected nodes" command="layout-selected" onPress={() => void layOutSelected()}>
        <IconHierarchy3 size={16} />
      </Tool>
    </>
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
    <Paper
      component="form"
      withBorder
      shadow="md"
      p={4}
      onSubmit={(event) => {
        event.preventDefault()
        if (!problem) void rename(path, name)
      }}
    >
      <TextInput
        ref={field}
        size="xs"
        aria-label={`New name of ${present}`}
        error={problem !== undefined}
        value={name}
        onChange={(event) => setName(event.currentTarget.value)}
        onKeyDown={(event) => event.key === 'Escape' && cancel()}
        onBlur={() => (problem ? cancel() : void rename(path, name))}
      />
      {problem && (
        <Text size="xs" c="var(--failed)" px={4} role="alert">
          {problem}
        </Text>
      )}
    </Paper>
  )
}
