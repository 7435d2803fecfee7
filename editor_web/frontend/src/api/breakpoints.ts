/** The breakpoints of the shown behavior: those of the run under way, and those kept beside its file. */
import { useMemo } from 'react'
import { completed, matches, toggled, type CompleteBreakpoint } from '../document/breakpoints'
import { api } from './client'
import { useLive } from './live'
import { useControl } from './liveParts'
import { showRefusal, send } from './refusal'
import { pageStore } from './pageStore'

interface Kept {
  readonly behavior: string
  readonly kept: readonly CompleteBreakpoint[]
}

export const useSavedBreakpoints = pageStore<Kept>(() => ({ behavior: '', kept: [] }))

/** Show the breakpoints of this behavior from now on. */
export async function loadSavedBreakpoints(behavior: string): Promise<void> {
  if (useSavedBreakpoints.getState().behavior !== behavior) useSavedBreakpoints.setState({ behavior, kept: [] })
  const answer = await send('Read the breakpoints', () => api.keptBreakpoints(behavior))
  if (answer && useSavedBreakpoints.getState().behavior === behavior)
    useSavedBreakpoints.setState({ kept: answer.breakpoints.map(completed) })
}

/** Those that hold now: of the run while one is under way, else those for the next one. */
export function useBreakpoints(): readonly CompleteBreakpoint[] {
  const ofRun = useControl((control) => control?.breakpoints)
  const kept = useSavedBreakpoints((s) => s.kept)
  return useMemo(() => ofRun?.map(completed) ?? kept, [ofRun, kept])
}

/** Those that stop at this node, wildcards included. */
export function useBreakpointsAt(path: string): string {
  const all = useBreakpoints()
  const here = all.filter((each) => each.enabled && matches(each.path, path))
  return here
    .map((each) => each.when)
    .toSorted()
    .join(' ')
}

type Edit = (list: readonly CompleteBreakpoint[]) => readonly CompleteBreakpoint[]

/** Edit the breakpoints of the run and those beside the file alike; false when the server refused. */
export async function editBreakpoints(edit: Edit): Promise<boolean> {
  const { run, control, role } = useLive.getState()
  const { behavior, kept } = useSavedBreakpoints.getState()
  if (role !== 'operator') {
    showRefusal('Breakpoint', 'You may look only', 'log in with the operator token')
    return false
  }
  const done = await send('Breakpoint', async () => {
    const [answer] = await Promise.all([
      api.keepBreakpoints(behavior, { breakpoints: edit(kept) }),
      control && api.breakpoints(run, { breakpoints: edit(control.breakpoints.map(completed)) }),
    ])
    return answer
  })
  if (done && useSavedBreakpoints.getState().behavior === behavior) useSavedBreakpoints.setState({ kept: done.breakpoints.map(completed) })
  return done !== undefined
}

/** Set or take away the plain breakpoint of a node. */
export function toggleBreakpoint(path: string, when: CompleteBreakpoint['when'] = 'before'): Promise<boolean> {
  const { control } = useLive.getState()
  const shown = control?.breakpoints.map(completed) ?? useSavedBreakpoints.getState().kept
  const isSet = shown.some((each) => each.path === path && each.when === when)
  return editBreakpoints((list) => toggled(list, { path, when }, !isSet))
}
