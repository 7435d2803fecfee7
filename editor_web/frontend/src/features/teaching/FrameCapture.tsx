/** Captures where one frame of the cell is, seen from another. */
import { Button, NativeSelect, Popover, Stack } from '@mantine/core'
import { IconAxisX } from '@tabler/icons-react'
import { useState } from 'react'
import { useTeach } from '../../api/teaching'
import { CommandButton } from '../../components/CommandButton'
import { WORLD } from '../../document/poses'

interface FrameCaptureProps {
  readonly obstacle: string | undefined
  readonly onCapture: (source: string, target: string) => void
}

export function FrameCapture({ obstacle, onCapture }: FrameCaptureProps) {
  const frames = useTeach((s) => s.frames)
  const [isOpen, setOpen] = useState(false)
  const [source, setSource] = useState('')
  const [target, setTarget] = useState(WORLD)
  if (frames.length === 0) return null
  const from = source || (frames[0] ?? '')
  return (
    <Popover opened={isOpen} onChange={setOpen} position="bottom-end" width={260} shadow="md" trapFocus returnFocus>
      <Popover.Target>
        <Button
          variant="default"
          size="xs"
          px="xs"
          leftSection={<IconAxisX size={15} aria-hidden />}
          aria-disabled={obstacle === undefined ? undefined : true}
          data-disabled={obstacle !== undefined}
          title={obstacle === undefined ? 'Capture where a frame of the cell is' : `Not possible: ${obstacle}`}
          onClick={() => setOpen(!isOpen && obstacle === undefined)}
        >
          Frame
        </Button>
      </Popover.Target>
      <Popover.Dropdown>
        <Stack gap="xs">
          <NativeSelect
            size="xs"
            label="Where is"
            value={from}
            onChange={(event) => setSource(event.currentTarget.value)}
            data={[...frames]}
          />
          <NativeSelect
            size="xs"
            label="Seen from"
            value={target}
            onChange={(event) => setTarget(event.currentTarget.value)}
            data={[WORLD, ...frames.filter((each) => each !== WORLD)]}
          />
          <CommandButton
            label="Capture the frame"
            tone="strong"
            obstacle={obstacle ?? (from === target ? 'choose two frames' : undefined)}
            onPress={() => {
              setOpen(false)
              onCapture(from, target)
            }}
          />
        </Stack>
      </Popover.Dropdown>
    </Popover>
  )
}
