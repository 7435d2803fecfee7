/** The state of the run, why it is so, and what it asks: one row whose height no text changes. */
import { Button, Stack, Text } from '@mantine/core'
import { IconZoomExclamation } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import { useLive } from '../../api/live'
import { useOperated } from '../../api/liveStore'
import type { ControlView, GateWait, GraphNode, RunView } from '../../api/types'
import { RunTime } from '../../components/RunTime'
import { RunBadge } from '../../components/StatusBadge'
import { TextButton } from '../../components/TextButton'
import { LEVEL_WORDS, operatorWords, waitingWords } from '../../document/commands'
import { isActive, isFailed, requestsOf, runStateOf } from '../../document/runState'
import { Requests } from './Requests'
import classes from './StatusRow.module.css'
import type { Commands } from './useCommands'

export interface StatusRowProps {
  readonly run: RunView | undefined
  /** The graph of its behavior, where it can be read. */
  readonly root: GraphNode | null
  readonly commands: Commands
  /** Choose a node and bring it into view. */
  readonly onShow: (path: string) => void
  /** Show how the run failed; undefined where that is not shown. */
  readonly onFailure?: (() => void) | undefined
  /** What else holds the run up. */
  readonly notices?: ReactNode
  /** What it is the row of, where there are several. */
  readonly of?: string
}

export function StatusRow({ run, root, commands, onShow, onFailure, notices, of = '' }: StatusRowProps) {
  const control = useLive((s) => (run && isActive(run) ? s.control : null))
  const asks = requestsOf(control).length > 0
  const hasFailed = run !== undefined && !isActive(run) && isFailed(run)
  return (
    <section className={classes.place} aria-label={of ? `Status of ${of}` : 'Status of the run'}>
      <div className={classes.row}>
        <div className={classes.state}>
          <span role="status" aria-label={of ? `State of ${of}` : 'State of the run'}>
            <RunBadge run={run} control={control} />
          </span>
          {run && <RunTime run={run} />}
        </div>
        <Stack gap={2} miw={0}>
          {notices}
          <Reason run={run} control={control} onShow={onShow} />
          {control && run && <Operator run={run} control={control} />}
        </Stack>
        <div className={classes.question} data-asks={asks || undefined}>
          <Requests root={root} commands={commands} onShow={onShow} of={of} isRow />
          {hasFailed && onFailure && (
            <Button
              variant="light"
              color="red"
              size="compact-sm"
              leftSection={<IconZoomExclamation size={15} aria-hidden />}
              onClick={onFailure}
            >
              Show failure
            </Button>
          )}
        </div>
      </div>
    </section>
  )
}

interface ReasonProps {
  readonly run: RunView | undefined
  readonly control: ControlView | null
  readonly onShow: (path: string) => void
}

/** One line: what the state does not say, and where the run waits. */
function Reason({ run, control, onShow }: ReasonProps) {
  const { reason, look } = runStateOf(run, control)
  // What asks has its own place in the row.
  const waiting = control?.waiting.filter((each) => !each.reasons.includes('autonomy')) ?? []
  const words = waiting.map((each) => `${each.path} ${waitingWords(each)}`)
  return (
    <Text component="div" inherit truncate c={look === 'failed' ? 'var(--failed)' : 'inherit'} title={[reason, ...words].join('\n')}>
      {run ? reason : <Quiet>Set the parameters and press Start.</Quiet>}
      {waiting.length > 0 && ' '}
      {waiting.length > 0 && (
        <ul className={classes.waits} aria-label="Nodes that wait">
          {waiting.map((each) => (
            <Waiting key={`${each.path}|${each.point}`} wait={each} onShow={onShow} />
          ))}
        </ul>
      )}
    </Text>
  )
}

function Waiting({ wait, onShow }: { readonly wait: GateWait; readonly onShow: (path: string) => void }) {
  return (
    <li>
      <TextButton onPress={() => onShow(wait.path)}>{wait.path}</TextButton> {waitingWords(wait)}
    </li>
  )
}

/** Whom the run asks, and for what. */
function Operator({ run, control }: { readonly run: RunView; readonly control: ControlView }) {
  const isMine = useOperated() === run.id
  const autonomy = `Autonomy ${control.autonomy}: ${LEVEL_WORDS[control.autonomy]}.`
  const operator = operatorWords(control, isMine)
  return (
    <Text component="div" inherit truncate title={`${operator}\n${autonomy}`}>
      {control.operator === 'lost' ? (
        <Text span inherit c="var(--stopped)" fw={650}>
          {operator}
        </Text>
      ) : (
        <Quiet>{operator}</Quiet>
      )}{' '}
      <Quiet>{autonomy}</Quiet>
    </Text>
  )
}

function Quiet({ children }: { readonly children: string }) {
  return (
    <Text span inherit c="var(--quiet)">
      {children}
    </Text>
  )
}
