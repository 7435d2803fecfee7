/** Above the canvas: where one is, and how it is seen. */
import { Box, Flex, Group, Space, Text, UnstyledButton } from '@mantine/core'
import {
  IconArrowLeft,
  IconArrowsMaximize,
  IconRoute2,
  IconHierarchy3,
  IconMap,
  IconMinus,
  IconNote,
  IconNotes,
  IconPlus,
  IconSelect,
  IconSquarePlus,
} from '@tabler/icons-react'
import { useReactFlow } from '@xyflow/react'
import { type ComponentProps, useMemo } from 'react'
import { nodeOf } from '../../document/editing/model'
import { pathsTo } from '../../document/path'
import { focusNode } from './actions'
import { openAddPalette } from './paletteRequests'
import { trackViewportMotion } from './viewportMotion'
import { openOther } from './pageActions'
import { addFreeNote } from './freeNotes'
import { toggleNotes, useNotes } from './notes'
import { referrerOf } from './references'
import { toggleDataFlow, useDataFlow } from './dataFlow'
import { layOutAnew } from './placing'
import { wholeCanvas } from './viewport'
import classes from './frame.module.css'
import { draftOf, rootOf, scopeOf, setEditor, useEditor } from './store'
import { Tool } from './Tool'

export interface CanvasBarProps {
  readonly hasMap: boolean
  readonly onMap: () => void
  readonly boxSelects: boolean
  readonly onBoxSelects: () => void
}

export function CanvasBar({ hasMap, onMap, boxSelects, onBoxSelects }: CanvasBarProps) {
  const { setViewport, zoomIn, zoomOut } = useReactFlow()
  const isStale = useEditor((s) => draftOf(s).isStale)
  const hasNotes = useNotes((s) => s.isShown)
  const hasFlow = useDataFlow((s) => s.isShown)
  return (
    <Group wrap="nowrap" gap={2} mih={38} pl="sm" pr="xs" bg="var(--surface)" className={classes['bar']}>
      <Path />
      {isStale && (
        <Text span size="xs" ml="sm" c="var(--failed)" truncate role="status">
          The text cannot be read; this is how it was before.
        </Text>
      )}
      <Space flex={1} />
      <Tool label="Add a state or container" command="add" onPress={() => openAddPalette()}>
        <IconSquarePlus size={17} />
      </Tool>
      <Tool label="Drag a box to choose" isPressed={boxSelects} onPress={onBoxSelects}>
        <IconSelect size={17} />
      </Tool>
      <Tool label="Data flow: writers and readers of each key" command="data-flow" isPressed={hasFlow} onPress={toggleDataFlow}>
        <IconRoute2 size={17} />
      </Tool>
      <Tool label="Notes on the canvas" isPressed={hasNotes} onPress={toggleNotes}>
        <IconNote size={17} />
      </Tool>
      <Tool label="Add a free note" command="free-note" onPress={addFreeNote}>
        <IconNotes size={17} />
      </Tool>
      <Tool label="Auto-layout" command="layout" onPress={() => void layOutAnew()}>
        <IconHierarchy3 size={17} />
      </Tool>
      <Tool label="Overview" isPressed={hasMap} onPress={onMap}>
        <IconMap size={17} />
      </Tool>
      <Tool label="Zoom out" command="zoom-out" onPress={() => trackViewportMotion(zoomOut({ duration: 120 }))}>
        <IconMinus size={17} />
      </Tool>
      <Tool label="Zoom in" command="zoom-in" onPress={() => trackViewportMotion(zoomIn({ duration: 120 }))}>
        <IconPlus size={17} />
      </Tool>
      <Tool label="Show all" command="fit" onPress={() => trackViewportMotion(setViewport(wholeCanvas(), { duration: 200 }))}>
        <IconArrowsMaximize size={17} />
      </Tool>
    </Group>
  )
}

/** From the behavior down to what fills the canvas. */
function Path() {
  const scope = useEditor((s) => scopeOf(s)?.path ?? 'root')
  const root = useEditor(rootOf)
  const name = useEditor((s) => draftOf(s).document?.name ?? '')
  const id = useEditor((s) => s.id)
  const from = useMemo(() => referrerOf(id), [id])
  return (
    <Box component="nav" miw={0} aria-label="Shown container">
      <Flex component="ol" className="plain-list cut-text" gap={5} fz="xs" c="dimmed">
        {from && (
          <li>
            <Crumb onClick={() => openOther(from.id, from.node)} title={`Back to ${from.id}`}>
              <IconArrowLeft size={13} aria-hidden /> {from.name}
            </Crumb>{' '}
            /
          </li>
        )}
        {pathsTo(scope).map((path, index) => (
          <li key={path}>
            {index > 0 && '/ '}
            <Crumb
              aria-current={path === scope ? 'location' : undefined}
              onClick={() => {
                const inside = pathsTo(scope)[pathsTo(path).length]
                setEditor({ scope: path, selection: inside ? [inside] : [], arrow: undefined })
                if (inside) focusNode(inside)
              }}
            >
              {path === 'root' ? name || 'root' : (nodeOf(root, path)?.name ?? path)}
            </Crumb>
          </li>
        ))}
      </Flex>
    </Box>
  )
}

function Crumb({ children, ...of }: ComponentProps<'button'>) {
  return (
    <UnstyledButton fz="inherit" {...(of['aria-current'] ? { c: 'var(--text)', fw: 620 } : { c: 'inherit' })} {...of}>
      {children}
    </UnstyledButton>
  )
}
