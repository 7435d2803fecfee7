/** Where two runs first differ, in words, and the jump there. */
import { Button, Group, Text } from '@mantine/core'
import { IconArrowDown, IconEqual, IconGitFork } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import type { Divergence } from '../../api/types'

interface FirstDivergenceProps {
  readonly divergence: Divergence | null
  readonly onShow: () => void
}

export function FirstDivergence({ divergence, onShow }: FirstDivergenceProps) {
  if (!divergence) {
    return (
      <Line color="var(--done-soft)">
        <IconEqual size={18} aria-hidden />
        <Text inherit flex={1} style={{ overflowWrap: 'anywhere' }}>
          Both runs visited the same nodes, and each ended in the same way.
        </Text>
      </Line>
    )
  }
  const times = [
    divergence.left_s !== null && `left at ${divergence.left_s.toFixed(2)} s`,
    divergence.right_s !== null && `right at ${divergence.right_s.toFixed(2)} s`,
  ]
  return (
    <Line color="var(--stopped-soft)">
      <IconGitFork size={18} aria-hidden />
      <Text inherit flex={1} style={{ overflowWrap: 'anywhere' }}>
        <strong>First divergence:</strong> {divergence.text}{' '}
        <Text span inherit c="dimmed">
          ({times.filter(Boolean).join(', ')})
        </Text>
      </Text>
      <Button variant="default" size="xs" leftSection={<IconArrowDown size={14} aria-hidden />} onClick={onShow}>
        Show
      </Button>
    </Line>
  )
}

function Line({ color, children }: { readonly color: string; readonly children: ReactNode }) {
  return (
    <Group gap="sm" wrap="nowrap" px="md" py="xs" bg={color} style={{ borderBottom: '1px solid var(--line)' }} role="status">
      {children}
    </Group>
  )
}
