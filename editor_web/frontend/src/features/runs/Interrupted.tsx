/** Runs whose engine died: what they ask, and going on with them. */
import { Refusal } from '../../components/Refusal'
import { lookup, type Dict } from '../../document/dict'
import { Button, Checkbox, Group, List, Paper, Radio, Stack, Text } from '@mantine/core'
import { IconHeartbeat } from '@tabler/icons-react'
import { useState } from 'react'
import { api, ServerError } from '../../api/client'
import type { ErrorBody, InterruptedRun, ResumeQuestion } from '../../api/types'
import { wallTime } from '../../document/time'

export interface InterruptedProps {
  readonly runs: readonly InterruptedRun[]
  /** Why nothing can be resumed from this page. */
  readonly obstacle: string | undefined
  readonly onResumed: (run: string) => void
}

export function Interrupted({ runs, obstacle, onResumed }: InterruptedProps) {
  return (
    <List listStyleType="none">
      {runs.map((run) => (
        <Resumable key={run.id} run={run} obstacle={obstacle} onResumed={onResumed} />
      ))}
    </List>
  )
}

interface ResumableProps extends Omit<InterruptedProps, 'runs'> {
  readonly run: InterruptedRun
}

function Resumable({ run, obstacle, onResumed }: ResumableProps) {
  const [questions, setQuestions] = useState<readonly ResumeQuestion[]>([])
  const [answers, setAnswers] = useState<Dict<string>>({})
  const [changed, setChanged] = useState(false)
  const [problem, setProblem] = useState<ErrorBody>()
  const [isSent, setSent] = useState(false)
  const isOpen = questions.some((question) => !lookup(answers, question.path))

  async function resume(): Promise<void> {
    setSent(true)
    try {
      onResumed((await api.resumeInterrupted(run.id, { answers, changed })).run)
    } catch (error) {
      const asked = error instanceof ServerError ? error.questions : []
      setQuestions(asked.length > 0 ? asked : questions)
      const answer = error instanceof ServerError ? error.body : { message: String(error), where: '', hint: '' }
      setProblem(asked.length > 0 ? undefined : answer)
    } finally {
      setSent(false)
    }
  }

  return (
    <li aria-label={`Interrupted run of ${run.behavior}`}>
      <Stack gap="2xs" py="3xs">
        <Group gap="2xs" align="start" wrap="nowrap">
          <IconHeartbeat size={18} aria-hidden />
          <span>
            <strong>{run.behavior}</strong>{' '}
            <Text span inherit ff="monospace">
              {run.id}
            </Text>
            <Text span display="block" fz="0.8rem">
              started {wallTime(run.started_unix_s)}; its engine ended in the middle of it, after event {run.last_seq}
            </Text>
          </span>
        </Group>
        {questions.length > 0 && (
          <Paper component={Stack} gap="xs" px="sm" py="xs" bg="var(--surface)">
            <Text inherit>
              These states had begun and nobody knows whether they had their effect. Look at the cell, then say what became of each: it is
              either run again from its start, or taken as ended.
            </Text>
            {questions.map((question) => (
              <Radio.Group
                key={question.path}
                label={question.path}
                size="sm"
                value={lookup(answers, question.path) ?? ''}
                onChange={(answer) => setAnswers({ ...answers, [question.path]: answer })}
              >
                <Radio value="rerun" label="Run it again" size="sm" />
                {question.outcomes.map((outcome) => (
                  <Radio key={outcome} value={outcome} label={`It ended with ${outcome}`} size="sm" />
                ))}
              </Radio.Group>
            ))}
          </Paper>
        )}
        {problem && (
          <Refusal title="It was not resumed:" hint={problem.hint}>
            {problem.message}
          </Refusal>
        )}
        <Group gap="3xs">
          <Button size="compact-sm" disabled={obstacle !== undefined || isOpen || isSent} title={obstacle} onClick={() => void resume()}>
            {questions.length > 0 ? 'Go on with these answers' : 'Resume'}
          </Button>
          <Checkbox
            size="xs"
            label="Also if its file has changed since"
            checked={changed}
            onChange={(event) => setChanged(event.currentTarget.checked)}
          />
        </Group>
      </Stack>
    </li>
  )
}
