/** Says that the past is shown, which moment of it, and leads back. */
import { Box, Button, Group, Paper, Text, VisuallyHidden } from '@mantine/core'
import { IconHistory } from '@tabler/icons-react'
import { useEffect } from 'react'
import { backToPresent, leave, servesCell, useTimeline } from '../../api/timeline'
import { useLive } from '../../api/live'
import type { RunView } from '../../api/types'
import classes from './PastLine.module.css'
import { useSubject } from './useSubject'

export interface PastLineProps {
  readonly run: RunView | undefined
  readonly hasCellView: boolean
}

export function PastLine({ run, hasCellView }: PastLineProps) {
  const subject = useSubject(run)
  const timeS = useTimeline((s) => s.timeS)
  const problem = useTimeline((s) => s.problem)
  const isActive = useLive((s) => s.control !== null)
  useEffect(() => servesCell(hasCellView), [hasCellView])
  useEffect(() => (subject && !subject.isPast ? () => leave(subject) : undefined), [subject])
  if (!subject || timeS === undefined) return null
  return (
    <Box pos="relative" h={0} style={{ zIndex: 20 }}>
      <Paper
        shadow="md"
        component={Group}
        className={classes.line ?? ''}
        data-past-line
        wrap="nowrap"
        gap="xs"
        py={4}
        pl="sm"
        pr={6}
        bg="var(--stopped-soft)"
      >
        <IconHistory size={17} color="var(--stopped)" style={{ flex: 'none' }} aria-hidden />
        <Text span size="sm">
          {/* Told once, not with every step of the cursor. */}
          <VisuallyHidden role="status">You see the past</VisuallyHidden>
          <span aria-hidden>
            You see <strong>{timeS.toFixed(2)} s</strong> of the past{isActive && '; the bar above commands the run as it is now'}
          </span>
          {problem && <span role="alert"> {problem}</span>}
        </Text>
        <Button variant="light" size="compact-sm" radius="xl" flex="none" onClick={() => backToPresent(subject)}>
          {subject.isPast ? 'To the end' : 'Back to live'}
        </Button>
      </Paper>
    </Box>
  )
}
