/** What holds a node: the dots of its breakpoints, its lock, and the words of what it waits for. */
import { UnstyledButton } from '@mantine/core'
import { IconLock } from '@tabler/icons-react'
import { toggleBreakpoint, useBreakpointsAt } from '../../api/breakpoints'
import { useHolds } from '../../api/liveParts'
import { useIsPage } from '../../api/liveStore'
import classes from './step.module.css'

export function Marks({ path }: { path: string }) {
  const points = useBreakpointsAt(path)
  const isLocked = useHolds((control) => control?.locks.includes(path) ?? false)
  const waits = useHolds((control) => control?.waiting.some((each) => each.path === path) ?? false)
  return (
    <>
      {waits && <span className={classes.waits} data-mark="waits" />}
      <Dot path={path} when="before" isSet={points.includes('before')} />
      {points.includes('after') && <Dot path={path} when="after" isSet />}
      {isLocked && (
        <span className={classes.lock} data-mark="lock" title="Locked: its outcome is held">
          <IconLock size={13} aria-hidden />
        </span>
      )}
    </>
  )
}

/** For the mouse; the keyboard has the key `b` and the form of the selected node. Set only on the page of the run. */
function Dot({ path, when, isSet }: { path: string; when: 'before' | 'after'; isSet: boolean }) {
  const isPage = useIsPage()
  if (!isPage) return isSet && <span className={classes.dot} data-when={when} data-set title={`Pauses ${when} this node`} />
  return (
    <UnstyledButton
      tabIndex={-1}
      className={classes.dot}
      data-when={when}
      data-set={isSet || undefined}
      aria-label={`Breakpoint ${when} ${path}`}
      aria-pressed={isSet}
      title={isSet ? `Pauses ${when} this node; click to let it pass` : 'Click to pause before this node'}
      onClick={(event) => {
        event.stopPropagation()
        void toggleBreakpoint(path, when)
      }}
    />
  )
}

const WORDS: Record<string, string> = { pause: 'paused', lock: 'locked', autonomy: 'asks' }

/** `paused`, `asks: held`. */
export function HeldText({ path }: { path: string }) {
  const words = useHolds((control) => {
    const waiting = control?.waiting.find((each) => each.path === path)
    if (!waiting) return ''
    const reasons = waiting.reasons.map((reason) => WORDS[reason] ?? 'held').join(', ')
    return waiting.outcome ? `${reasons}: ${waiting.outcome}` : reasons
  })
  return words ? <span className={`${classes.held} cut-text`}>{words}</span> : null
}
