/** What the operator can do with the shown run: each command, and why it is not possible now. */
import { lookup } from '../../document/dict'
import { useMemo, useState } from 'react'
import { api } from '../../api/client'
import { operate, useLive } from '../../api/live'
import { showRefusal, send } from '../../api/refusal'
import type { RunView } from '../../api/types'
import { disabledReason, type Command, type Level, type Situation } from '../../document/commands'

export interface Commands {
  /** Why a command is not possible; undefined when it is. */
  readonly obstacle: (command: Command) => string | undefined
  /** Show why a command is not possible. */
  readonly explain: (command: Command, words: string) => void
  readonly pauseOrResume: () => void
  readonly step: (mode: 'into' | 'over' | 'out') => void
  readonly stepBack: () => void
  readonly stop: () => void
  readonly setAutonomy: (level: Level) => Promise<boolean>
  readonly toggleOperating: () => void
  /** Apply the current file; with `preempt` what is active and has changed is preempted. */
  readonly change: (preempt: boolean) => void
  readonly lock: (path: string, reason: string) => Promise<unknown>
  readonly unlock: (path: string) => Promise<unknown>
  readonly force: (path: string, outcome: string) => Promise<unknown>
  readonly repeat: (path: string) => Promise<unknown>
  readonly answer: (path: string) => Promise<unknown>
  /** What the last hot change did; undefined before one, or when its words were put away. */
  readonly report: readonly string[] | undefined
  readonly forgetReport: () => void
}

/** `name` says in refusals which run is meant, on a page that shows several. */
export function useCommands(run: RunView | undefined, node: string | undefined, name = ''): Commands {
  const role = useLive((s) => s.role)
  const isConnected = useLive((s) => s.connection === 'live')
  const control = useLive((s) => s.control)
  const nodeStatus = useLive((s) => (node ? (lookup(s.nodes, node)?.status ?? 'idle') : 'idle'))
  const [report, setReport] = useState<readonly string[]>()
  const id = run?.id ?? ''

  return useMemo(() => {
    const now: Situation = { role, isConnected, run, control, node, nodeStatus }
    // A chosen node that waits says which branch is meant.
    const branch = control?.waiting.some((each) => each.path === node) ? (node ?? '') : ''
    const obstacle = (command: Command) => disabledReason(command, now)
    const of = (words: string) => (name ? `${name}: ${words}` : words)
    const sendOf = <T>(words: string, request: () => Promise<T>) => send(of(words), request)
    /** Send it, or say why not. */
    const attempt = (command: Command, words: string, request: () => Promise<unknown>): void => {
      const why = obstacle(command)
      if (why) showRefusal(of(words), why)
      else void sendOf(words, request)
    }
    return {
      obstacle,
      explain: (command, words) => showRefusal(of(words), obstacle(command) ?? ''),
      pauseOrResume: () => {
        const isHeld = control?.paused === true && !control.stepping
        if (isHeld) attempt('resume', 'Resume', () => api.resume(id))
        else attempt('pause', 'Pause', () => api.pause(id))
      },
      step: (mode) => attempt('step', `Step ${mode}`, () => api.step(id, { mode, path: branch })),
      stepBack: () => attempt('back', 'Step back', () => api.stepBack(id, branch || (nodeStatus === 'active' ? (node ?? '') : ''))),
      stop: () => attempt('stop', 'Stop', () => api.stop(id)),
      setAutonomy: async (level) => (await sendOf('Autonomy', () => api.autonomy(id, level))) !== undefined,
      toggleOperating: () => {
        const why = obstacle('operate')
        if (why) showRefusal(of('Take control'), why)
        else operate(useLive.getState().operated === id ? '' : id)
      },
      change: (preempt) => attempt('change', 'Apply the current file', async () => setReport((await api.change(id, { preempt })).changes)),
      lock: (path, reason) => sendOf('Lock', () => api.lock(id, path, reason)),
      unlock: (path) => sendOf('Unlock', () => api.unlock(id, path)),
      force: (path, outcome) => sendOf(`Force ${outcome}`, () => api.force(id, path, outcome)),
      repeat: (path) => sendOf('Run again', () => api.repeat(id, path)),
      answer: (path) => sendOf('Agree', () => api.answer(id, path)),
      report,
      forgetReport: () => setReport(undefined),
    }
  }, [role, isConnected, run, control, node, nodeStatus, id, name, report])
}
