/** One run among several: how it stands, what is active, what it waits for, what it holds, and its commands. */
import { Checkbox } from '@mantine/core'
import type { ReactNode } from 'react'
import { useLive } from '../../api/live'
import { useNodePart } from '../../api/liveParts'
import type { GraphNode, RunView } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { PageLink } from '../../components/PageLink'
import { StatusIcon } from '../../components/StatusIcon'
import { waitingWords } from '../../document/commands'
import { activeLeaves } from '../../document/runProgress'
import { runStateOf } from '../../document/runState'
import { wallTime } from '../../document/time'
import { pathWords } from '../../document/path'
import { nameOf } from './RunList'
import { RunStrip } from './RunStrip'

export interface RunCardProps {
  readonly run: RunView
  /** Its graph, where its document can be read. */
  readonly root: GraphNode | null
  /** The arms and devices that it commands. */
  readonly held: readonly string[]
  readonly href: string
  readonly onOpen: () => void
  /** Is it one of those that are to be shown side by side? */
  readonly isChosen: boolean
  readonly onChoose: (isChosen: boolean) => void
  /** What it asks. */
  readonly requests: ReactNode
  readonly commands: ReactNode
}

export function RunCard({ run, root, held, href, onOpen, isChosen, onChoose, requests, commands }: RunCardProps) {
  const control = useLive((s) => s.control)
  const isKnown = useLive((s) => s.run === run.id)
  const name = nameOf(run.behavior)
  const state = runStateOf(run, control)
  return (
    <article className={`run-card${run.waits ? ' is-waiting' : ''}`} aria-label={`Run of ${name}`}>
      <header className="run-card-head">
        <StatusIcon status={state.look} size={17} />
        <h2>
          <PageLink href={href} onOpen={onOpen}>
            {name}
          </PageLink>
        </h2>
        {isKnown && <Elapsed sinceS={0} />}
        <span className="quiet">since {wallTime(run.started_at_s)}</span>
        <span className="spacer" />
        <Checkbox
          size="xs"
          label="Compare"
          aria-label={`Compare ${name}`}
          checked={isChosen}
          onChange={(event) => onChoose(event.currentTarget.checked)}
        />
      </header>
      <p className={`run-card-state is-${state.look}`}>
        <strong role="status" aria-label={`State of ${name}`}>
          {state.word}
        </strong>
        {state.reason && <span className="quiet"> {state.reason}</span>}
      </p>
      {root && <RunStrip root={root} />}
      <dl className="run-facts">
        <dt>Active</dt>
        <dd>
          <Active />
        </dd>
        <Waiting />
        <dt>Holds</dt>
        <dd>{held.length > 0 ? held.join(', ') : <span className="quiet">no arm or device</span>}</dd>
      </dl>
      {requests}
      {commands}
    </article>
  )
}

function Active() {
  const active = useLive((s) => activeLeaves(s.nodes).join('\n'))
  if (!active) return <span className="quiet">nothing</span>
  return (
    <ul className="plain-list run-active" aria-label="Active nodes">
      {active.split('\n').map((path) => (
        <ActiveNode key={path} path={path} />
      ))}
    </ul>
  )
}

function ActiveNode({ path }: { path: string }) {
  const enteredS = useNodePart(path, (live) => live?.entered_s ?? 0)
  return (
    <li>
      <span className="run-active-name">{pathWords(path)}</span> <Elapsed sinceS={enteredS} />
    </li>
  )
}

/** What asks has its own place below. */
function Waiting() {
  const control = useLive((s) => s.control)
  const waiting = control?.waiting.filter((each) => !each.reasons.includes('autonomy')) ?? []
  if (waiting.length === 0) return null
  return (
    <>
      <dt>Waits</dt>
      <dd>
        <ul className="plain-list" aria-label="Nodes that wait">
          {waiting.map((each) => (
            <li key={`${each.path}|${each.point}`}>
              {pathWords(each.path)} {waitingWords(each)}
            </li>
          ))}
        </ul>
      </dd>
    </>
  )
}
