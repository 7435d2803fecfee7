/** One node on the canvas: a leaf, or a container with its children drawn inside. */
import { Handle, Position, type NodeProps } from '@xyflow/react'
import { UnstyledButton } from '@mantine/core'
import { IconChevronDown, IconChevronRight, IconLogout } from '@tabler/icons-react'
import { createContext, Fragment, memo, useContext } from 'react'
import { useLive } from '../../api/live'
import { useNodeLive, useNodePart } from '../../api/liveParts'
import type { NodeLive } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { GoalLine } from '../../components/GoalLine'
import { KindIcon } from '../../components/KindIcon'
import { OthersHere } from '../../components/OthersHere'
import { StatusIcon } from '../../components/StatusIcon'
import { lookup } from '../../document/dict'
import { transitionId } from '../../document/edgeId'
import { nameOfPath, pathsTo, pathWords } from '../../document/path'
import { activeLeaves } from '../../document/runProgress'
import { statusOf } from '../../document/runState'
import { disabledText } from '../../document/editing/disabling'
import { duration } from '../../document/time'
import { kindLabel } from '../../document/tree'
import type { OutcomeNode, StepNode } from './elements'
import { HeldText, Marks } from './Marks'
import classes from './step.module.css'

/** The behavior that is drawn: those who have a node of it selected on other pages are shown at it. */
export const DocumentContext = createContext('')
/** Folds a container by its path, or unfolds it. */
export const FoldContext = createContext<((path: string) => void) | undefined>(undefined)

export const LeafNode = memo(function LeafNode({ id, data, selected }: NodeProps<StepNode>) {
  const live = useNodeLive(id)
  const status = statusOf(live?.status ?? 'idle')
  return (
    <div
      className={`${classes.step} ${classes.leaf}`}
      data-node="leaf"
      data-status={status}
      data-disabled={data.isPassedOver || undefined}
      data-selected={selected || undefined}
    >
      <Ports />
      {data.isInitial && <span className={classes.initial} title="The first state" />}
      <Marks path={id} />
      {/* A new key starts the animation again, so that a visit shorter than a frame is seen. */}
      <span key={live?.visits ?? 0} className={live && live.visits > 0 ? classes.blink : undefined} />
      <div className={classes.head}>
        <StatusIcon status={status} />
        <KindIcon icon={data.node.icon} />
        <Name name={data.node.name} />
        <Others path={id} isFolded={data.isFolded} />
        {data.isFolded && <Fold path={id} isFolded />}
        {live && live.visits > 1 && (
          <span className={classes.quiet} style={{ marginLeft: 'auto' }}>
            ×{live.visits}
          </span>
        )}
      </div>
      <div className={`${classes.title} cut-text`}>
        {data.node.disabled === false ? data.node.title || kindLabel(data.node.kind) : disabledText(data.node.disabled)}
      </div>
      <div className={classes.live}>
        <LiveText live={live} />
        {data.isFolded && <ActiveInside path={id} />}
        <HeldText path={id} />
        <GoalLine path={id} />
      </div>
      <Exits data={data} />
    </div>
  )
})

export const ContainerNode = memo(function ContainerNode({ id, data, selected }: NodeProps<StepNode>) {
  const live = useNodeLive(id)
  const status = statusOf(live?.status ?? 'idle')
  const { node } = data
  return (
    <div
      className={`${classes.step} ${classes.container}`}
      data-node="container"
      data-kind={node.kind}
      data-status={status}
      data-disabled={data.isPassedOver || undefined}
      data-selected={selected || undefined}
    >
      <Ports />
      {data.isInitial && <span className={classes.initial} title="The first state" />}
      <Marks path={id} />
      <div className={classes.head}>
        <KindIcon icon={node.icon} />
        <Name name={node.name} />
        <Others path={id} />
        <span className={`${classes.kind} cut-text`}>{node.disabled === false ? kindLabel(node.kind) : disabledText(node.disabled)}</span>
        <span style={{ flex: 1 }} />
        <HeldText path={id} />
        {status !== 'idle' && <StatusIcon status={status} size={14} />}
        <span className={classes.live}>
          <LiveText live={live} />
        </span>
        {data.machine && <Fold path={id} isFolded={false} />}
      </div>
      <div style={{ paddingInline: 14 }}>
        {node.conditions.length > 0 && (
          <div className={`${classes.conditions} cut-text`} title={node.conditions.join('\n')}>
            {node.conditions.join(' · ')}
          </div>
        )}
        <Exits data={data} />
      </div>
    </div>
  )
})

/** Who else has the node selected, or one inside of a folded one. */
function Others(at: { path: string; isFolded?: boolean }) {
  return <OthersHere document={useContext(DocumentContext)} {...at} />
}

/** The name of a node, which may go on in a second line after an underscore. */
function Name({ name }: { name: string }) {
  return (
    <span className={`${classes.name} cut-text`}>
      {name.split('_').map((part, index) => (
        <Fragment key={index}>
          {index > 0 && (
            <>
              _<wbr />
            </>
          )}
          {part}
        </Fragment>
      ))}
    </span>
  )
}

/** Folds a container, or unfolds it. */
function Fold({ path, isFolded }: { path: string; isFolded: boolean }) {
  const toggle = useContext(FoldContext)
  if (!toggle) return null
  const Icon = isFolded ? IconChevronRight : IconChevronDown
  return (
    <UnstyledButton
      className={`${classes.fold} nodrag`}
      aria-label={`${isFolded ? 'Expand' : 'Collapse'} ${pathWords(path)}`}
      aria-expanded={!isFolded}
      onClick={(event) => {
        event.stopPropagation()
        toggle(path)
      }}
    >
      <Icon size={16} aria-hidden />
    </UnstyledButton>
  )
}

/** The outcomes that are written here instead of drawn; those that were taken are lit, the latest one most. */
function Exits({ data }: { data: StepNode['data'] }) {
  const lastTransition = useNodePart(data.machine, (live) => (data.exits.length > 0 ? live?.last_transition : undefined))
  const taken = useNodePart(data.node.path, (live) => (data.exits.length > 0 ? live?.taken : undefined))
  if (data.exits.length === 0) return null
  return (
    <div className={classes.exits}>
      {data.exits.map(({ outcome, target }) => {
        const isLatest = lastTransition === transitionId({ source: data.node.name, outcome })
        const count = (taken && lookup(taken, outcome)) ?? 0
        return (
          <span
            key={outcome}
            data-exit={outcome}
            data-taken={isLatest || undefined}
            {...(count > 0 && !isLatest ? { style: { color: 'var(--done)' } } : {})}
            title={`${outcome} ends the machine with ${target}`}
          >
            <IconLogout size={11} aria-hidden />
            {outcome === target ? outcome : `${outcome} → ${target}`}
            {count > 1 && ` ×${count}`}
          </span>
        )
      })}
    </div>
  )
}

/** What is active inside a folded container: `grasp, lift`. */
function ActiveInside({ path }: { path: string }) {
  const names = useLive((s) =>
    activeLeaves(s.nodes)
      .filter((leaf) => pathsTo(leaf).includes(path))
      .map(nameOfPath)
      .join(', '),
  )
  return <span className={classes.quiet}>{names}</span>
}

function LiveText({ live }: { live: NodeLive | undefined }) {
  if (!live || live.status === 'idle') return <span className={classes.quiet}>{live && live.visits > 0 ? 'waiting again' : ''}</span>
  if (live.status === 'skipped') return <span className={classes.outcomeText}>skipped</span>
  if (live.status === 'active') {
    return <Elapsed sinceS={live.entered_s} />
  }
  return (
    <>
      <span className={classes.outcomeText}>{live.status === 'stopped' ? 'stopped' : live.outcome}</span>
      <span className={classes.quiet}>{duration(live.duration_s)}</span>
    </>
  )
}

export const OutcomeNodeShell = memo(function OutcomeNodeShell({ data }: NodeProps<OutcomeNode>) {
  const reached = useNodePart(data.machine, (machine) =>
    machine !== undefined && machine.status !== 'active' && machine.outcome === data.outcome ? machine.status : 'idle',
  )
  return (
    <div className={classes.outcome} data-node="outcome" data-status={statusOf(reached)}>
      <Ports />
      {data.outcome}
    </div>
  )
})

/** The canvas wants ends for its arrows; ours come with their courses, so these are never seen. */
function Ports() {
  return (
    <>
      <Handle type="target" position={Position.Left} style={{ visibility: 'hidden' }} isConnectable={false} />
      <Handle type="source" position={Position.Right} style={{ visibility: 'hidden' }} isConnectable={false} />
    </>
  )
}
