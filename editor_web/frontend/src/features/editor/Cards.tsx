/** The nodes of the editor's canvas: states, containers open and closed, parts of trees, outcomes, rules. */
import { Handle, Position, type NodeProps } from '@xyflow/react'
import {
  IconAlertTriangleFilled,
  IconCircleXFilled,
  IconClock,
  IconFlag,
  IconNote,
  IconQuestionMark,
  IconRefresh,
  IconShieldHalf,
} from '@tabler/icons-react'
import { memo } from 'react'
import { disabledText } from '../../document/editing/disabling'
import { isFailure, type OutgoingTransition } from '../../document/editing/model'
import { consequenceOf } from '../../document/editing/rules'
import { kindLabel } from '../../document/tree'
import { IN, type CardData, type CardNode, type PillNode, type RulesNode } from './elements'
import { NodeIcon } from './NodeIcon'
import { useMark, useTransitionFindings } from './marks'

export const LeafCard = memo(function LeafCard({ id, data, selected }: NodeProps<CardNode>) {
  const { node } = data
  return (
    <div className={`card leaf-card kind-${node.kind}${stateClasses(data, selected)}`}>
      <Entry data={data} />
      {data.isInitial && <InitialMark />}
      <div className="card-head">
        <NodeIcon className="kind-icon" kind={node.kind} />
        {node.role && <span className="card-role">{node.role}</span>}
        <div className="card-titles">
          <span className="card-name">{node.name}</span>
          <span className="card-title">{node.disabled === false ? node.title || insideText(data) : disabledText(node.disabled)}</span>
        </div>
        <Extras data={data} />
        <MarkIcon path={id} inside={node.children.length > 0} />
      </div>
      <Transitions path={id} data={data} />
    </div>
  )
})

function insideText({ node, count }: CardData): string {
  return count === 0 ? `${kindLabel(node.kind)}, empty` : `${kindLabel(node.kind)} of ${count}`
}

export const FrameCard = memo(function FrameCard({ id, data, selected }: NodeProps<CardNode>) {
  const { node } = data
  return (
    <div className={`card frame-card kind-${node.kind}${stateClasses(data, selected)}`}>
      <Entry data={data} />
      {data.isInitial && <InitialMark />}
      <div className="frame-head">
        <NodeIcon className="kind-icon" kind={node.kind} />
        <span className="card-name">{node.name}</span>
        <span className="frame-kind">{node.disabled === false ? node.title || kindLabel(node.kind) : disabledText(node.disabled)}</span>
        {node.kind === 'behavior' && <span className="frame-foreign">read only</span>}
        <span className="spacer" />
        <Extras data={data} />
        <MarkIcon path={id} inside={false} />
      </div>
      {node.children.length === 0 && <div className="frame-empty">Empty: add a state, or drop one here</div>}
      <span className="spacer" />
      {node.kind === 'concurrency' && <RuleTable node={node} />}
      <Transitions path={id} data={data} />
    </div>
  )
})

export const TwigCard = memo(function TwigCard({ id, data, selected }: NodeProps<CardNode>) {
  const { node } = data
  return (
    <div className={`card twig-card kind-${node.kind}${stateClasses(data, selected)}`}>
      <Handle type="target" id="above" position={Position.Top} className="branch-port" isConnectable={false} />
      <NodeIcon className="kind-icon" kind={node.kind} size={15} />
      {node.role && <span className="card-role">{node.role}</span>}
      <span className="card-name">{node.name}</span>
      {node.disabled !== false && <span className="twig-disabled">disabled</span>}
      {node.guard && <IconShieldHalf size={13} aria-label="guarded" />}
      {!data.isOpen && data.count > 0 && <span className="twig-count">{data.count}</span>}
      <MarkIcon path={id} inside={!data.isOpen} />
      <Handle type="source" id="below" position={Position.Bottom} className="branch-port" isConnectable={false} />
    </div>
  )
})

function stateClasses(data: CardData, selected: boolean): string {
  return `${selected ? ' is-selected' : ''}${data.isForeign ? ' is-foreign' : ''}${data.isPassedOver ? ' is-disabled' : ''}`
}

/** Above in a tree; in a machine at the left, at the height of the first outcome. */
function Entry({ data }: { data: CardData }) {
  return data.isInTree ? (
    <Handle type="target" id="above" position={Position.Top} className="branch-port" isConnectable={false} />
  ) : (
    <Handle type="target" id={IN} position={Position.Left} className="in-port" style={{ top: data.entryY }} isConnectableStart={false} />
  )
}

function InitialMark() {
  return (
    <span className="initial-flag" title="The machine begins here">
      <IconFlag size={11} aria-hidden />
      <span className="visually-hidden">begins here</span>
    </span>
  )
}

/** Small signs of what is set beside the kind. */
function Extras({ data: { node } }: { data: CardData }) {
  const asks = Object.entries(node.autonomy)
  return (
    <span className="extras">
      {node.guard && <IconShieldHalf size={13} aria-label="guarded" />}
      {node.retry && <IconRefresh size={13} aria-label="retried" />}
      {node.timeout && <IconClock size={13} aria-label="with a timeout" />}
      {asks.length > 0 && <IconQuestionMark size={13} aria-label="asks the operator" />}
      {(node.description || node.notes) && <IconNote size={13} aria-label="has a note" />}
    </span>
  )
}

function MarkIcon({ path, inside }: { path: string; inside: boolean }) {
  const mark = useMark(path, inside)
  if (!mark) return null
  const Icon = mark.severity === 'error' ? IconCircleXFilled : IconAlertTriangleFilled
  return (
    <span className={`mark is-${mark.severity}`} title={mark.messages.join('\n')}>
      <Icon size={15} aria-hidden />
      <span className="visually-hidden">
        {mark.messages.length} {mark.severity === 'error' ? 'errors' : 'warnings'}
      </span>
    </span>
  )
}

/** A row with a port for each outcome. */
function Transitions({ path, data }: { path: string; data: CardData }) {
  if (data.transitions.length === 0) return null
  return (
    <div className="transition-rows">
      {data.transitions.map((transition) => (
        <TransitionRow
          key={transition.outcome}
          path={path}
          transition={transition}
          isDrawn={data.drawn.has(transition.outcome)}
          isForeign={data.isForeign}
        />
      ))}
    </div>
  )
}

function TransitionRow({
  path,
  transition,
  isDrawn,
  isForeign,
}: {
  path: string
  transition: OutgoingTransition
  isDrawn: boolean
  isForeign: boolean
}) {
  const findings = useTransitionFindings(path, transition.outcome)
  const isLoose = transition.target === undefined
  const classes = `${isLoose ? ' is-loose' : ''}${isFailure(transition.outcome) ? ' is-failure' : ''}${findings.length > 0 ? ' has-finding' : ''}`
  return (
    <div className={`transition-row${classes}`} title={findings.map((finding) => finding.message).join('\n') || undefined}>
      <span className="transition-outcome">{transition.outcome}</span>
      {!isDrawn && !isLoose && transition.target !== transition.outcome && <span className="transition-target">→ {transition.target}</span>}
      {!isDrawn && transition.target === transition.outcome && <span className="transition-target">↦</span>}
      <Handle
        type="source"
        id={transition.outcome}
        position={Position.Right}
        className="out-port"
        isConnectable={!isForeign && transition.isOutcome}
        isConnectableEnd={false}
      />
    </div>
  )
}

export const PillCard = memo(function PillCard({ data }: NodeProps<PillNode>) {
  return (
    <div className={`pill${data.count === 0 ? ' is-loose' : ''}${isFailure(data.outcome) ? ' is-failure' : ''}`}>
      <Handle type="target" id={IN} position={Position.Left} className="in-port" isConnectableStart={false} />
      <span>{data.outcome}</span>
      {data.count !== 1 && <span className="pill-count">{data.count === 0 ? 'unused' : `×${data.count}`}</span>}
    </div>
  )
})

export const RulesCard = memo(function RulesCard({ data }: NodeProps<RulesNode>) {
  return (
    <div className="rules-card">
      <RuleTable node={data.node} />
    </div>
  )
})

/** When a concurrency container ends: the first rule that holds counts. */
function RuleTable({ node }: { node: CardData['node'] }) {
  return (
    <div className="rules">
      <div className="rules-head">Ends with</div>
      {node.rules.length === 0 && <div className="rule is-missing">no rule yet</div>}
      {node.rules.map((rule, index) => (
        <div key={index} className="rule">
          <span className={`rule-outcome${isFailure(rule.outcome) ? ' is-failure' : ''}`}>{consequenceOf(rule)}</span>
          <span className="rule-when">
            {rule.at_least !== null && <em>{rule.at_least} of </em>}
            {Object.entries(rule.when).map(([child, outcome], position) => (
              <span key={child}>
                {position > 0 && <em>{rule.at_least === null ? ' and ' : ', '}</em>}
                {child} = {outcome}
              </span>
            ))}
          </span>
        </div>
      ))}
      {node.otherwise && (
        <div className="rule">
          <span className={`rule-outcome${isFailure(node.otherwise) ? ' is-failure' : ''}`}>{node.otherwise}</span>
          <span className="rule-when">otherwise</span>
        </div>
      )}
    </div>
  )
}
