/** The menu of a node in the graph of a run: where to start, and where to pause. */
import { Box, Menu } from '@mantine/core'
import { toggleBreakpoint, useBreakpointsAt } from '../../api/breakpoints'
import { askStartHere } from '../../api/startHere'
import type { GraphNode } from '../../api/types'
import type { Point } from '../../document/geometry'

export interface GraphMenuProps {
  readonly behavior: string
  readonly node: GraphNode
  /** Where on the screen. */
  readonly at: Point
  readonly onClose: () => void
}

export function GraphMenu({ behavior, node, at, onClose }: GraphMenuProps) {
  const { path } = node
  const isSet = useBreakpointsAt(path).includes('before')
  const isOff = path === 'root' || node.disabled !== false
  return (
    <Menu opened onClose={onClose} position="bottom-start" offset={2} withinPortal shadow="md" returnFocus>
      <Menu.Target>
        <Box component="span" pos="fixed" w={0} h={0} left={at.x} top={at.y} />
      </Menu.Target>
      <Menu.Dropdown aria-label={`Node ${node.name}`}>
        <Menu.Item disabled={isOff} onClick={() => askStartHere({ behavior, path, kind: 'from' })}>
          Run from here…
        </Menu.Item>
        <Menu.Item disabled={isOff} onClick={() => askStartHere({ behavior, path, kind: 'to' })}>
          Run to here…
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item onClick={() => void toggleBreakpoint(path)}>{isSet ? 'Remove breakpoint' : 'Set breakpoint'}</Menu.Item>
      </Menu.Dropdown>
    </Menu>
  )
}
