/** Moves an arm, or pushes at it, by a handle in the 3D view. */
import { Button, Popover, SegmentedControl, Stack, Text } from '@mantine/core'
import { IconHandMove } from '@tabler/icons-react'
import { useEffect, useState } from 'react'
import { showHandle, useHandleDrag, type HandleMode } from '../../api/handleDrag'
import { useLive } from '../../api/live'

const WORDS: Record<HandleMode, string> = {
  move: 'Drag the handle: the tool follows slowly, as long as the mouse is down.',
  push: 'Drag the handle: an arm that floats is pulled towards it. In simulation only.',
}

export function HandleMenu() {
  const [isOpen, setOpen] = useState(false)
  const robots = useLive((s) => s.robots)
  const { arm, mode, pulled, refused } = useHandleDrag()
  useEffect(() => () => showHandle(''), [])
  const arms = Object.keys(robots)
  if (arms.length === 0) return null
  return (
    <Popover opened={isOpen} onChange={setOpen} position="bottom-end" width={290} shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button
          variant={arm ? 'light' : 'default'}
          size="compact-sm"
          aria-pressed={arm !== ''}
          title="Move an arm by a handle in the 3D view"
          leftSection={<IconHandMove size={15} aria-hidden />}
          onClick={() => setOpen(!isOpen)}
        >
          {arm ? `Handle: ${arm}` : 'Handle'}
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="xs">
          <SegmentedControl
            fullWidth
            size="xs"
            aria-label="Arm with the handle"
            data={[{ value: '', label: 'None' }, ...arms.map((each) => ({ value: each, label: each }))]}
            value={arm}
            onChange={(next) => showHandle(next, mode)}
          />
          <SegmentedControl
            fullWidth
            size="xs"
            aria-label="Function of the handle"
            disabled={arm === ''}
            data={[
              { value: 'move', label: 'Move the tool' },
              { value: 'push', label: 'Push the arm' },
            ]}
            value={mode}
            onChange={(next) => showHandle(arm, next)}
          />
          <Text size="xs" c="dimmed">
            {WORDS[mode]}
          </Text>
          <Text role="status" size="xs" c={refused ? 'var(--failed)' : 'dimmed'}>
            {refused || (pulled ? `${arm} follows` : '')}
          </Text>
        </Stack>
      </Popover.Dropdown>
    </Popover>
  )
}
