/** The chosen steps in their order: what each is for, and what a grasp takes. */
import { IconArrowDown, IconArrowUp, IconX } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import type { TaughtStep } from '../../api/types'
import { KIND_WORDS, moved, ROLE_WORDS, rolesOf, takes, type Role, type Step } from '../../document/demonstration'
import { KindIcon } from './EntryChoice'

export interface StepListProps {
  readonly steps: readonly Step[]
  /** As the proposal of these steps decided; missing while it is being made. */
  readonly decided: readonly TaughtStep[]
  readonly parts: readonly string[]
  readonly onChange: (steps: readonly Step[]) => void
}

export function StepList({ steps, decided, parts, onChange }: StepListProps) {
  function changed(key: number, change: Partial<Step>): void {
    onChange(steps.map((step) => (step.key === key ? { ...step, ...change } : step)))
  }
  return (
    <section className="chosen" aria-label="Steps">
      <h3>Steps in their order</h3>
      {steps.length === 0 && <p className="quiet">Add taught entries, in the order of execution.</p>}
      <ol className="chosen-list">
        {steps.map((step, index) => {
          const known = fitting(decided, steps) ? decided[index] : undefined
          const words = step.kind === 'action' ? `${ROLE_WORDS[step.name === 'close' ? 'close' : 'open']} gripper` : step.name
          return (
            <li key={step.key} className="chosen-step" aria-label={`Step ${index + 1}: ${words}`}>
              <KindIcon kind={step.kind} />
              <span className="chosen-name">{words}</span>
              {step.kind !== 'action' && <span className="quiet chosen-kind">{KIND_WORDS[step.kind]}</span>}
              {rolesOf(step.kind).length > 1 && step.kind !== 'action' && (
                <RoleChoice step={step} guessed={known?.role ?? undefined} onChange={(role) => changed(step.key, { role })} />
              )}
              <span className="chosen-tools">
                <StepButton label="Earlier" isOff={index === 0} onPress={() => onChange(moved(steps, index, -1))}>
                  <IconArrowUp size={14} aria-hidden />
                </StepButton>
                <StepButton label="Later" isOff={index === steps.length - 1} onPress={() => onChange(moved(steps, index, 1))}>
                  <IconArrowDown size={14} aria-hidden />
                </StepButton>
                <StepButton label="Remove" onPress={() => onChange(steps.filter((each) => each.key !== step.key))}>
                  <IconX size={14} aria-hidden />
                </StepButton>
              </span>
              {known && takes(known, decided[index - 1]) && (
                <PartChoice part={step.part ?? known.part ?? ''} parts={parts} onChange={(part) => changed(step.key, { part })} />
              )}
            </li>
          )
        })}
      </ol>
    </section>
  )
}

/** Whether what was decided is about these steps, and not about those before a change. */
function fitting(decided: readonly TaughtStep[], steps: readonly Step[]): boolean {
  return decided.length === steps.length && decided.every((each, index) => each.name === steps[index]?.name)
}

interface RoleChoiceProps {
  readonly step: Step
  readonly guessed: Role | undefined
  readonly onChange: (role: Role) => void
}

function RoleChoice({ step, guessed, onChange }: RoleChoiceProps) {
  return (
    <select
      className={`chosen-select${step.role ? '' : ' is-guessed'}`}
      aria-label={`What ${step.name} is for`}
      title={step.role ? undefined : 'Guessed from order, names and places'}
      value={step.role ?? guessed ?? ''}
      onChange={(event) => onChange(event.currentTarget.value as Role)}
    >
      {(step.role ?? guessed) === undefined && <option value="">…</option>}
      {rolesOf(step.kind).map((role) => (
        <option key={role} value={role}>
          {ROLE_WORDS[role]}
        </option>
      ))}
    </select>
  )
}

interface PartChoiceProps {
  readonly part: string
  readonly parts: readonly string[]
  readonly onChange: (part: string) => void
}

function PartChoice({ part, parts, onChange }: PartChoiceProps) {
  return (
    <label className="chosen-part">
      takes
      <select className="chosen-select" aria-label="Grasped part" value={part} onChange={(event) => onChange(event.currentTarget.value)}>
        <option value="">a part without a name</option>
        {[...new Set([...parts, ...(part ? [part] : [])])].map((name) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
      </select>
    </label>
  )
}

interface StepButtonProps {
  readonly label: string
  readonly isOff?: boolean
  readonly onPress: () => void
  readonly children: ReactNode
}

function StepButton({ label, isOff = false, onPress, children }: StepButtonProps) {
  return (
    <button type="button" className="icon-button" aria-label={label} title={label} disabled={isOff} onClick={onPress}>
      {children}
    </button>
  )
}
