/** The menu of a node in the graph of a run: where to start, where to pause and when, and where else it is used. */
import { Box, Kbd, Menu, Popover, Text } from '@mantine/core'
import { useState, type ReactNode } from 'react'
import { toggleBreakpoint, useBreakpointsAt } from '../../api/breakpoints'
import { useKeyOf } from '../../api/keyMap'
import { askStartHere } from '../../api/startHere'
import type { GraphNode } from '../../api/types'
import { findUsages } from '../../api/usages'
import type { Point } from '../../document/geometry'

export interface GraphMenuProps {
  readonly behavior: string
  readonly node: GraphNode
  /** The conditions of its breakpoints. */
  readonly breakpointForm: ReactNode
  /** Where on the screen. */
  readonly at: Point
  readonly onClose: () => void
}

export function GraphMenu({ behavior, node, breakpointForm, at, onClose }: GraphMenuProps) {
  const { path } = node
  const [isForm, setForm] = useState(false)
  const isSet = useBreakpointsAt(path).includes('before')
  const key = useKeyOf('break').text
  const isOff = path === 'root' || node.disabled !== false
  const anchor = <Box component="span" pos="fixed" w={0} h={0} left={at.x} top={at.y} />
  if (isForm) {
    return (
      <Popover
        withRoles={false}
        opened
        onDismiss={onClose}
        position="bottom-start"
        offset={2}
        withinPortal
        trapFocus
        returnFocus
        shadow="md"
        width={340}
      >
        <Popover.Target>{anchor}</Popover.Target>
        <Popover.Dropdown role="dialog" aria-label={`Breakpoints of ${node.name}`}>
          <Text size="sm" fw={620}>
            Breakpoints of {node.name}
          </Text>
          {breakpointForm}
        </Popover.Dropdown>
      </Popover>
    )
  }
  return (
    <Menu opened onClose={onClose} position="bottom-start" offset={2} withinPortal shadow="md" returnFocus closeOnItemClick={false}>
      <Menu.Target>{anchor}</Menu.Target>
      <Menu.Dropdown aria-label={`Node ${node.name}`}>
        <Menu.Item disabled={isOff} onClick={then(() => askStartHere({ behavior, path, kind: 'from' }))}>
          Run from here…
        </Menu.Item>
        <Menu.Item disabled={isOff} onClick={then(() => askStartHere({ behavior, path, kind: 'to' }))}>
          Run to here…
        </Menu.Item>
        <Menu.Divider />
        <Menu.Item onClick={then(() => void toggleBreakpoint(path))} rightSection={key && <Kbd size="xs">{key}</Kbd>}>
          {isSet ? 'Remove breakpoint' : 'Set breakpoint'}
        </Menu.Item>
        <Menu.Item onClick={() => setForm(true)}>Breakpoint: condition and count…</Menu.Item>
        {node.kind === 'state' && (
          <>
            <Menu.Divider />
            <Menu.Item onClick={then(() => findUsages({ kind: 'state', name: node.title }))}>Find usages of {node.title}</Menu.Item>
          </>
        )}
      </Menu.Dropdown>
    </Menu>
  )

  function then(act: () => void): () => void {
    return () => {
      onClose()
      act()
    }
  }
}
