/** One service or action: what it is for, the form of its request, and its answer or course. */
import { lookup } from '../../document/dict'
import { Button, Paper, Progress, Text } from '@mantine/core'
import { IconPlayerStopFilled, IconSend } from '@tabler/icons-react'
import { busQueries } from '../../api/bus'
import { useAnswer } from '../../api/queryClient'
import { ValueTree } from '../../components/ValueTree'
import { Caution, Detail } from './Detail'
import { RequestForm } from './RequestForm'
import { cancel, isOver, send, useRequests, type RequestProgress } from './requests'
import { useForm } from './useForm'
import type { SkillInfo } from '../../api/types'

interface SkillViewProps {
  readonly facts: SkillInfo
  readonly mayChange: boolean
  readonly onBack: () => void
}

export function SkillView({ facts, mayChange, onBack }: SkillViewProps) {
  const form = useForm(useAnswer(busQueries.requestForm(facts.name)))
  const course = useRequests((s) => lookup(s.courses, facts.name))
  const isAction = facts.kind === 'action'
  const isActive = course !== undefined && !isOver(course)
  return (
    <Detail name={facts.name} type={`${facts.type} → ${facts.answer}`} doc={facts.doc} onBack={onBack}>
      <Caution
        mayChange={mayChange}
        words={
          isAction
            ? 'This may move the robot. The goal is cancelled when you leave this page.'
            : 'This may affect the robot and may move it.'
        }
      />
      <RequestForm
        label={`Request to ${facts.name}`}
        form={form}
        isOff={!mayChange || isActive}
        onSend={(request) => void send(facts, request)}
        refusal={course?.status === 'refused' ? course.cause : ''}
        buttons={
          <>
            <Button type="submit" size="xs" disabled={!mayChange || isActive} leftSection={<IconSend size={14} aria-hidden />}>
              {isAction ? 'Send goal' : 'Call'}
            </Button>
            {isActive && isAction && (
              <Button
                size="xs"
                color="red"
                variant="outline"
                onClick={() => void cancel(facts.name)}
                leftSection={<IconPlayerStopFilled size={14} aria-hidden />}
              >
                Cancel goal
              </Button>
            )}
          </>
        }
      />
      {course && course.status !== 'refused' && <CourseView course={course} />}
    </Detail>
  )
}

function CourseView({ course }: { course: RequestProgress }) {
  const share = shareOf(course.feedback)
  return (
    <Paper withBorder px="xs" py="2xs" role="status" aria-label="Course of the request">
      <Text fz="0.8rem" fw={600} c={STATUS_COLORS[course.status] ?? 'var(--active)'}>
        {STATUS_WORDS[course.status] ?? course.status}
        {course.cause && `: ${course.cause}`}
      </Text>
      {share !== undefined && !isOver(course) && <Progress value={share * 100} size="sm" aria-label="Progress" />}
      {course.feedback !== null && course.feedback !== undefined && !isOver(course) && (
        <ValueTree label="Feedback" value={course.feedback} />
      )}
      {course.answer !== null && course.answer !== undefined && <ValueTree label="Answer" value={course.answer} />}
    </Paper>
  )
}

function shareOf(feedback: unknown): number | undefined {
  const share = typeof feedback === 'object' && feedback !== null ? (feedback as { progress?: unknown }).progress : undefined
  return typeof share === 'number' ? Math.min(1, Math.max(0, share)) : undefined
}

/** What goes on is active. */
const STATUS_COLORS: Readonly<Record<string, string>> = {
  held: 'var(--text)',
  succeeded: 'var(--done)',
  answered: 'var(--done)',
  aborted: 'var(--failed)',
  rejected: 'var(--failed)',
  canceled: 'var(--stopped)',
}

const STATUS_WORDS: Readonly<Record<string, string>> = {
  sent: 'Sent',
  pending: 'Waits to be accepted',
  active: 'Active',
  held: 'Held',
  canceling: 'Comes to rest',
  succeeded: 'Done',
  canceled: 'Cancelled, the device is at rest',
  aborted: 'It failed',
  rejected: 'It was refused',
  answered: 'Answered',
}
