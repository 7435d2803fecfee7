import { describe, expect, it } from 'vitest'
import type { TaughtStep } from '../api/types'
import { added, bodyOf, rolesOf, takes, teachable, type Role, type Step } from './demonstration'
import { reordered } from './reorder'

const home: Step = { key: 1, kind: 'joints', name: 'home' }
const pick: Step = { key: 2, kind: 'pose', name: 'pick', role: 'grasp', part: '' }

function decided(role: Role): TaughtStep {
  return { kind: 'action', name: 'close', role, part: null }
}

describe('steps of a demonstration', () => {
  it('are added at the end, each with a key of its own', () => {
    expect(added(added([], 'joints', 'home'), 'joints', 'home')).toEqual([home, { ...home, key: 2 }])
    expect(added([{ ...home, key: 7 }], 'pose', 'a')[1]?.key).toBe(8)
  })

  it('change places, and stay where there is none', () => {
    expect(reordered([home, pick], 0, 1)).toEqual([pick, home])
    expect(reordered([home, pick], 1, -1)).toEqual([pick, home])
    expect(reordered([home, pick], 0, -1)).toEqual([home, pick])
    expect(reordered([home, pick], 1, 1)).toEqual([home, pick])
  })

  it('are sent without what nobody chose', () => {
    expect(bodyOf(home)).toEqual({ kind: 'joints', name: 'home' })
    expect(bodyOf(pick)).toEqual({ kind: 'pose', name: 'pick', role: 'grasp', part: '' })
  })

  it('are for what their kind can be for', () => {
    expect(rolesOf('pose')).toContain('grasp')
    expect(rolesOf('cart_dmp')).toEqual(['follow'])
    expect(rolesOf('gripper')).toEqual(['open', 'close'])
  })

  it('take something where the tool closes on it', () => {
    expect(takes(decided('grasp'), undefined)).toBe(true)
    expect(takes(decided('close'), decided('grasp'))).toBe(false)
    expect(takes(decided('close'), decided('follow'))).toBe(true)
    expect(takes(decided('open'), undefined)).toBe(false)
  })

  it('come from entries that have a place or a motion', () => {
    const entries = ['joints', 'record', 'dmp', 'detection'].map((kind) => ({ kind, name: 'a', tags: [] }))
    expect(teachable(entries).map((each) => each.kind)).toEqual(['joints', 'dmp'])
  })
})
