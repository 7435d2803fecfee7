/** What happens around a node: guard, timeout, retry, errors, when it is asked again, and what to do with it after a crash. */
import { NativeSelect } from '@mantine/core'
import { lookup } from '../../document/dict'
import { isFailure, isMachine, isTreePart, type EditNode } from '../../document/editing/model'
import { setField } from '../../document/editing/edits'
import { looseValue, shownValue } from '../../document/editing/fields'
import { perform, performOn } from './apply'
import { FormLine } from './FormParts'
import { Section } from './Section'
import { TemplateInput } from './TemplateInput'
import { declaredOutcomes } from '../../document/editing/expansion'
import { draftOf, rootOf, useEditor } from './store'

export function PolicyForm({ node, parent }: { node: EditNode; parent: EditNode | undefined }) {
  const root = useEditor(rootOf)
  const outcomes = useEditor((s) => draftOf(s).document?.outcomes ?? NONE)
  const success = useEditor((s) => draftOf(s).document?.success ?? NONE)
  const targets = targetsOf(node, parent, root, outcomes)
  const set = (field: string, value: unknown) => void perform(`${field} of ${node.name}`, [setField(node.path, field, value)])
  const measure = (field: 'guard' | 'timeout' | 'retry', key: string, value: unknown) =>
    void performOn(node.path, `${field} of ${node.name}`, (now) => {
      const next = Object.fromEntries(
        Object.entries({ ...now[field], [key]: value }).filter(([, each]) => each !== undefined && each !== ''),
      )
      // A measure without what makes it one is no measure.
      if (!({ guard: 'when', timeout: 'after', retry: 'times' }[field] in next)) return [setField(node.path, field, null)]
      const leads = field !== 'retry' && !('to' in next) && targets[0] ? { to: worst(targets, success) } : {}
      return [setField(node.path, field, { ...leads, ...next })]
    })
  const inTree = parent !== undefined && isTreePart(parent.kind)
  const isPart = isTreePart(node.kind) && node.kind !== 'tree' && inTree
  const isSet = [node.guard, node.timeout, node.retry, node.on_error, node.every, node.resume].some((each) => each !== null)
  return (
    <Section title={isPart ? 'Guard' : 'Guard, timeout, retry'} isClosed={!isSet} note={isSet ? 'set' : undefined}>
      <FormLine label="Enter only when">
        <TemplateInput
          label="Guard"
          isMono
          placeholder="${…}"
          value={shownValue(node.guard?.['when'])}
          onCommit={(typed) => measure('guard', 'when', typed || undefined)}
        />
      </FormLine>
      {node.guard && (
        <Target
          label="Else go to"
          name="Guard target"
          value={shownValue(node.guard['to'])}
          targets={inTree ? [...targets, 'skipped'] : targets}
          onSet={(to) => measure('guard', 'to', to)}
        />
      )}
      {!isPart && <MoreConduct node={node} parent={parent} targets={targets} set={set} measure={measure} />}
    </Section>
  )
}

interface ConductProps {
  readonly node: EditNode
  readonly parent: EditNode | undefined
  readonly targets: readonly string[]
  readonly set: (field: string, value: unknown) => void
  readonly measure: (field: 'guard' | 'timeout' | 'retry', key: string, value: unknown) => void
}

/** What only nodes that run something have. */
function MoreConduct({ node, parent, targets, set, measure }: ConductProps) {
  return (
    <>
      <FormLine label="Stop it after">
        <TemplateInput
          label="Timeout"
          placeholder="such as 30 s"
          value={shownValue(node.timeout?.['after'])}
          onCommit={(typed) => measure('timeout', 'after', typed === '' ? undefined : looseValue(typed))}
        />
      </FormLine>
      {node.timeout && (
        <Target
          label="Then go to"
          name="Timeout target"
          value={shownValue(node.timeout['to'])}
          targets={targets}
          onSet={(to) => measure('timeout', 'to', to)}
        />
      )}
      <FormLine label="Run again up to">
        <TemplateInput
          label="Retry, times"
          inputMode="decimal"
          placeholder="times"
          value={shownValue(node.retry?.['times'])}
          onCommit={(typed) => measure('retry', 'times', typed === '' ? undefined : looseValue(typed))}
        />
      </FormLine>
      {node.retry && (
        <>
          <FormLine label="Wait before">
            <TemplateInput
              label="Retry, first wait"
              placeholder="0 s"
              value={shownValue(node.retry['backoff'])}
              onCommit={(typed) => measure('retry', 'backoff', typed === '' ? undefined : looseValue(typed))}
            />
          </FormLine>
          <FormLine label="After outcomes">
            <TemplateInput
              label="Retry, outcomes"
              placeholder="errors only; such as missed, lost"
              value={Array.isArray(node.retry['outcomes']) ? node.retry['outcomes'].join(', ') : ''}
              onCommit={(typed) => measure('retry', 'outcomes', typed === '' ? undefined : typed.split(/[\s,]+/).filter(Boolean))}
            />
          </FormLine>
        </>
      )}
      <Target
        label="On an error"
        name="Error target"
        value={node.on_error ?? ''}
        none="the run ends"
        targets={targets}
        onSet={(to) => set('on_error', to || null)}
      />
      {(node.every !== null || asksAgain(node, parent)) && (
        <FormLine label="Ask again every">
          <TemplateInput
            label="Ask again every"
            placeholder="a check: such as 200 ms"
            value={shownValue(node.every)}
            onCommit={(typed) => set('every', typed === '' ? null : looseValue(typed))}
          />
        </FormLine>
      )}
      <FormLine label="After a crash">
        <NativeSelect
          size="xs"
          aria-label="After a crash"
          value={node.resume ?? ''}
          onChange={(event) => set('resume', event.currentTarget.value || null)}
          data={[
            { value: '', label: 'as the state says' },
            { value: 'rerun', label: 'run it again' },
            { value: 'ask', label: 'ask' },
            ...node.outcomes.map((outcome) => ({ value: outcome, label: `take it for ${outcome}` })),
          ]}
        />
      </FormLine>
    </>
  )
}

const NONE: readonly string[] = []

function targetsOf(
  node: EditNode,
  parent: EditNode | undefined,
  root: EditNode | undefined,
  outcomes: readonly string[],
): readonly string[] {
  if (!parent || !root) return outcomes
  if (isTreePart(parent.kind)) return ['failure', 'success']
  if (!isMachine(parent.kind)) return node.outcomes
  const ends = [...declaredOutcomes(root, outcomes)(parent), ...parent.outcomes]
  return [...new Set([...ends, ...parent.children.map((child) => child.name)])].filter((name) => name !== node.name)
}

/** Whether a container asks what has ended again while what stands behind it is at work. */
function asksAgain(node: EditNode, parent: EditNode | undefined): boolean {
  if (node.role === 'while') return true
  return (parent?.kind === 'sequence' || parent?.kind === 'selector') && lookup(parent.settings, 'memory') === false
}

/** Where something that went wrong leads unless said otherwise. */
function worst(targets: readonly string[], success: readonly string[]): string {
  return targets.find(isFailure) ?? targets.find((target) => !success.includes(target)) ?? targets[0] ?? ''
}

interface TargetProps {
  readonly label: string
  readonly name: string
  readonly value: string
  readonly targets: readonly string[]
  /** What it says where nothing is chosen. */
  readonly none?: string
  readonly onSet: (target: string) => void
}

function Target({ label, name, value, targets, none, onSet }: TargetProps) {
  return (
    <FormLine label={label}>
      <NativeSelect
        size="xs"
        aria-label={name}
        value={value}
        data={[
          ...(none !== undefined || value === '' ? [{ value: '', label: none ?? 'choose' }] : []),
          ...new Set([...targets, ...(value ? [value] : [])]),
        ]}
        onChange={(event) => onSet(event.currentTarget.value)}
      />
    </FormLine>
  )
}
