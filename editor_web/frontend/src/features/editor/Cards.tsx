/** The nodes of the editor's canvas: states, containers open and closed, parts of trees, outcomes, rules. */
import { VisuallyHidden } from '@mantine/core'
import { Handle, Position, type NodeProps } from '@xyflow/react'
import {
  IconAlertTriangleFilled,
  IconCircleXFilled,
  IconClock,
  IconFlag,
  IconGitMerge,
  IconNote,
  IconQuestionMark,
  IconRefresh,
  IconShieldHalf,
} from '@tabler/icons-react'
import { memo } from 'react'
import { KindIcon } from '../../components/KindIcon'
import { OthersHere } from '../../components/OthersHere'
import { disabledText } from '../../document/editing/disabling'
import { isFailure, type OutgoingTransition } from '../../document/editing/model'
import { consequenceOf } from '../../document/editing/rules'
import { kindLabel } from '../../document/tree'
import classes from './cards.module.css'
import { IN, type CardData, type CardNode, type PillNode, type RulesNode } from './elements'
import { useConflicts, useMark, useTransitionFindings } from './marks'
import { useEditor } from './store'

const QUIET = { color: 'var(--quiet)' }

export const LeafCard = memo(function LeafCard({ id, data, selected }: NodeProps<CardNode>) {
  const { node } = data
  return (
    <div className={classes['card']} data-card="leaf" data-kind={node.kind} {...looksOf(data, selected)}>
      <Entry data={data} />
      {data.isInitial && <InitialMark />}
      <div className={classes['head']} data-head>
        <KindIcon icon={node.icon} />
        {node.role && (
          <span className={classes['chip']} data-role>
            {node.role}
          </span>
        )}
        <div className={classes['titles']}>
          <span className={`${classes['name']} cut-text`} data-name>
            {node.name}
          </span>
          <span className={`${classes['title']} cut-text`}>
            {node.disabled === false ? node.title || insideText(data) : disabledText(node.disabled)}
          </span>
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
    <div className={classes['card']} data-card="frame" data-kind={node.kind} {...looksOf(data, selected)}>
      <Entry data={data} />
      {data.isInitial && <InitialMark />}
      <div className={classes['head']} data-head>
        <KindIcon icon={node.icon} />
        <span className={`${classes['name']} cut-text`} data-name>
          {node.name}
        </span>
        <span className={`${classes['kind']} cut-text`}>
          {node.disabled === false ? node.title || kindLabel(node.kind) : disabledText(node.disabled)}
        </span>
        {node.kind === 'behavior' && <span className={classes['chip']}>read only</span>}
        <Extras data={data} />
        <MarkIcon path={id} inside={false} />
      </div>
      {node.children.length === 0 && (
        <div className={`${classes['kind']} cut-text`} style={{ padding: '8px 16px' }}>
          Empty: add a state, or drop one here
        </div>
      )}
      {node.kind === 'concurrency' && <RuleTable node={node} />}
      <Transitions path={id} data={data} />
    </div>
  )
})

export const TwigCard = memo(function TwigCard({ id, data, selected }: NodeProps<CardNode>) {
  const { node } = data
  return (
    <div className={classes['card']} data-card="twig" data-kind={node.kind} {...looksOf(data, selected)}>
      <Handle type="target" id="above" position={Position.Top} className={classes['branch']} isConnectable={false} />
      <KindIcon icon={node.icon} size={15} />
      {node.role && (
        <span className={classes['chip']} data-role>
          {node.role}
        </span>
      )}
      <span className={`${classes['name']} cut-text`} data-name>
        {node.name}
      </span>
      {node.disabled !== false && <em className={`${classes['kind']} cut-text`}>disabled</em>}
      {node.guard && <IconShieldHalf size={13} aria-label="guarded" />}
      {!data.isOpen && data.count > 0 && <span className={classes['chip']}>{data.count}</span>}
      <MarkIcon path={id} inside={!data.isOpen} />
      <Handle type="source" id="below" position={Position.Bottom} className={classes['branch']} isConnectable={false} />
    </div>
  )
})

function looksOf(data: CardData, selected: boolean) {
  return {
    'data-selected': selected || undefined,
    'data-foreign': data.isForeign || undefined,
    'data-disabled': data.isPassedOver || undefined,
  }
}

/** Above in a tree; in a machine at the left, at the height of the first outcome. */
function Entry({ data }: { data: CardData }) {
  return data.isInTree ? (
    <Handle type="target" id="above" position={Position.Top} className={classes['branch']} isConnectable={false} />
  ) : (
    <Handle
      type="target"
      id={IN}
      position={Position.Left}
      className={classes['in']}
      style={{ top: data.entryY }}
      isConnectableStart={false}
    />
  )
}

function InitialMark() {
  return (
    <span className={classes['initial']} title="The machine begins here">
      <IconFlag size={11} aria-hidden />
      <VisuallyHidden>begins here</VisuallyHidden>
    </span>
  )
}

/** Small signs of what is set beside the kind. */
function Extras({ data: { node } }: { data: CardData }) {
  const asks = Object.entries(node.autonomy)
  return (
    <span className={classes['sign']}>
      {node.guard && <IconShieldHalf size={13} aria-label="guarded" />}
      {node.retry && <IconRefresh size={13} aria-label="retried" />}
      {node.timeout && <IconClock size={13} aria-label="with a timeout" />}
      {asks.length > 0 && <IconQuestionMark size={13} aria-label="asks the operator" />}
      {(node.description || node.notes) && <IconNote size={13} aria-label="has a note" />}
    </span>
  )
}

function MarkIcon(props: { path: string; inside: boolean }) {
  const document = useEditor((s) => s.id)
  return (
    <>
      <OthersHere document={document} path={props.path} isFolded={props.inside} />
      <ConflictIcon {...props} />
      <FindingIcon {...props} />
    </>
  )
}

/** Both the draft and the file have changed something of the node. */
function ConflictIcon({ path, inside }: { path: string; inside: boolean }) {
  const count = useConflicts(path, inside)
  if (count === 0) return null
  const words = `${count} ${count === 1 ? 'conflict' : 'conflicts'} with the file`
  return (
    <span className={classes['sign']} data-severity="warning" data-conflicts={count} title={words}>
      <IconGitMerge size={15} aria-hidden />
      <VisuallyHidden>{words}</VisuallyHidden>
    </span>
  )
}

function FindingIcon({ path, inside }: { path: string; inside: boolean }) {
  const mark = useMark(path, inside)
  if (!mark) return null
  const Icon = mark.severity === 'error' ? IconCircleXFilled : IconAlertTriangleFilled
  return (
    <span className={classes['sign']} data-severity={mark.severity} title={mark.messages.join('\n')}>
      <Icon size={15} aria-hidden />
      <VisuallyHidden>
        {mark.messages.length} {mark.severity === 'error' ? 'errors' : 'warnings'}
      </VisuallyHidden>
    </span>
  )
}

/** A row with a port for each outcome. */
function Transitions({ path, data }: { path: string; data: CardData }) {
  if (data.transitions.length === 0) return null
  return (
    <div className={classes['rows']}>
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
  return (
    <div
      className={classes['row']}
      data-outcome={transition.outcome}
      data-loose={isLoose || undefined}
      data-failure={isFailure(transition.outcome) || undefined}
      data-finding={findings.length > 0 || undefined}
      title={findings.map((finding) => finding.message).join('\n') || undefined}
    >
      <span className={`${classes['outcome']} cut-text`}>{transition.outcome}</span>
      {!isDrawn && !isLoose && transition.target !== transition.outcome && (
        <span className="cut-text" style={QUIET}>
          → {transition.target}
        </span>
      )}
      {!isDrawn && transition.target === transition.outcome && (
        <span className="cut-text" style={QUIET}>
          ↦
        </span>
      )}
      <Handle
        type="source"
        id={transition.outcome}
        position={Position.Right}
        className={classes['out']}
        isConnectable={!isForeign && transition.isOutcome}
        isConnectableEnd={false}
      />
    </div>
  )
}

export const PillCard = memo(function PillCard({ data }: NodeProps<PillNode>) {
  return (
    <div className={classes['pill']} data-loose={data.count === 0 || undefined} data-failure={isFailure(data.outcome) || undefined}>
      <Handle type="target" id={IN} position={Position.Left} className={classes['in']} isConnectableStart={false} />
      <span>{data.outcome}</span>
      {data.count !== 1 && <span className={`${classes['kind']} cut-text`}>{data.count === 0 ? 'unused' : `×${data.count}`}</span>}
    </div>
  )
})

export const RulesCard = memo(function RulesCard({ data }: NodeProps<RulesNode>) {
  return (
    <div style={{ height: '100%' }} data-card="rules">
      <RuleTable node={data.node} />
    </div>
  )
})

/** When a concurrency container ends: the first rule that holds counts. */
function RuleTable({ node }: { node: CardData['node'] }) {
  return (
    <div className={classes['rules']} data-rules>
      <span className="cut-text" style={QUIET}>
        Ends with
      </span>
      {node.rules.length === 0 && <div data-failure>no rule yet</div>}
      {node.rules.map((rule, index) => (
        <div key={index}>
          <span className={`${classes['outcome']} cut-text`} data-failure={isFailure(rule.outcome) || undefined}>
            {consequenceOf(rule)}
          </span>
          <span className="cut-text" style={QUIET}>
            {rule.at_least !== null && `${rule.at_least} of `}
            {Object.entries(rule.when).map(([child, outcome], position) => (
              <span key={child}>
                {position > 0 && (rule.at_least === null ? ' and ' : ', ')}
                {child} = {outcome}
              </span>
            ))}
          </span>
        </div>
      ))}
      {node.otherwise && (
        <div>
          <span className={`${classes['outcome']} cut-text`} data-failure={isFailure(node.otherwise) || undefined}>
            {node.otherwise}
          </span>
          <span className="cut-text" style={QUIET}>
            otherwise
          </span>
        </div>
      )}
    </div>
  )
}
