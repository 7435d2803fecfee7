/** One node on the canvas: a leaf, or a container with its children drawn inside. */
import { Handle, Position, type NodeProps } from '@xyflow/react'
import { IconArrowsSplit2, IconBox, IconFileImport, IconLogout, IconSitemap } from '@tabler/icons-react'
import { memo } from 'react'
import { useNodeLive, useNodePart } from '../../api/liveParts'
import type { NodeLive } from '../../api/types'
import { Elapsed } from '../../components/Elapsed'
import { GoalLine } from '../../components/GoalLine'
import { StatusIcon } from '../../components/StatusIcon'
import { statusOf } from '../../document/runState'
import { disabledText } from '../../document/editing/disabling'
import { duration } from '../../document/time'
import { kindLabel } from '../../document/tree'
import type { OutcomeNode, StepNode } from './elements'
import { HeldText, Marks } from './Marks'
import classes from './step.module.css'

const KIND_ICONS: Record<string, typeof IconBox> = {
  machine: IconSitemap,
  concurrency: IconArrowsSplit2,
  behavior: IconFileImport,
}

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
        <span className={classes.name}>{data.node.name}</span>
        {live && live.visits > 1 && <span className={classes.visits}>×{live.visits}</span>}
      </div>
      <div className={classes.title}>
        {data.node.disabled === false ? data.node.title || kindLabel(data.node.kind) : disabledText(data.node.disabled)}
      </div>
      <div className={classes.live}>
        <LiveText live={live} />
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
  const Icon = KIND_ICONS[node.kind] ?? IconBox
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
        <Icon size={16} color="var(--quiet)" style={{ flex: 'none' }} aria-hidden />
        <span className={classes.name}>{node.name}</span>
        <span className={classes.kind}>{node.disabled === false ? kindLabel(node.kind) : disabledText(node.disabled)}</span>
        <span style={{ flex: 1 }} />
        <HeldText path={id} />
        {status !== 'idle' && <StatusIcon status={status} size={14} />}
        <span className={classes.live}>
          <LiveText live={live} />
        </span>
      </div>
      <div style={{ paddingInline: 14 }}>
        {node.conditions.length > 0 && (
          <div className={classes.conditions} title={node.conditions.join('\n')}>
            {node.conditions.join(' · ')}
          </div>
        )}
        <Exits data={data} />
      </div>
    </div>
  )
})

/** The outcomes that are written here instead of drawn; the one that was taken is lit. */
function Exits({ data }: { data: StepNode['data'] }) {
  const lastTransition = useNodePart(data.machine, (live) => (data.exits.length > 0 ? live?.last_transition : undefined))
  if (data.exits.length === 0) return null
  return (
    <div className={classes.exits}>
      {data.exits.map(({ outcome, target }) => (
        <span
          key={outcome}
          data-exit={outcome}
          data-taken={lastTransition === `${data.node.name}|${outcome}` || undefined}
          title={`${outcome} ends the machine with ${target}`}
        >
          <IconLogout size={11} aria-hidden />
          {outcome === target ? outcome : `${outcome} → ${target}`}
        </span>
      ))}
    </div>
  )
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
