/** Planned paths: found at the node that asks or inside it, and said in words. */
import { describe, expect, it } from 'vitest'
import type { NodeLive, PlanLive, RobotLive, PathLive } from '../api/types'
import { blockedPaths, isProposed, plansOf, planWords, sinceWords } from './plannedPaths'

const plan: PlanLive = { robot: 'left', duration_s: 3.2, length_m: 1.238, found_by: 'RRTConnect', planning_s: 0.12 }
const node = (of: PlanLive | null): NodeLive => ({
  status: 'active',
  visits: 1,
  outcome: '',
  entered_s: 0,
  duration_s: 0,
  cause: '',
  last_transition: '',
  taken: {},
  plan: of,
})
const path = (state: string): PathLive => ({ state, reason: 'a hand', length_m: 1, since_s: 5 })
const robot = (name: string, of: PathLive | null): RobotLive => ({
  name,
  mode: 'moving',
  activity: '',
  error: '',
  speed_override: 1,
  controller: '',
  path: of,
  separation: '',
})

describe('the paths that a question is about', () => {
  const nodes = { root: node(null), 'root/pick': node(null), 'root/pick/plan': node(plan), 'root/picked': node(plan) }

  it('are those of the node and of what lies inside it', () => {
    expect(plansOf(nodes, 'root/pick/plan')).toEqual([plan])
    expect(plansOf(nodes, 'root/pick')).toEqual([plan])
    expect(plansOf(nodes, 'root/pick/other')).toEqual([])
  })

  it('say how long, how far, and who found them', () => {
    expect(planWords(plan)).toBe("3.20 s for 1.24 m of the tool's path, found by RRTConnect in 0.12 s")
  })

  it('are on view until the arm goes them', () => {
    expect([robot('left', path('proposed')), robot('left', path('moving')), undefined].map(isProposed)).toEqual([true, false, false])
  })
})

describe('arms whose path is blocked', () => {
  it('are listed by name', () => {
    const robots = {
      right: robot('right', path('blocked')),
      middle: robot('middle', path('moving')),
      left: robot('left', path('blocked')),
      far: robot('far', null),
    }
    expect(blockedPaths(robots).map((each) => each.robot)).toEqual(['left', 'right'])
  })

  it('tell for how long', () => {
    expect([sinceWords(-1), sinceWords(12.9), sinceWords(185)]).toEqual(['0 s', '12 s', '3:05 min'])
  })
})
