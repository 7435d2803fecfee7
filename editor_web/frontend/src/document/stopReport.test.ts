/** What is said of a STOP, for each way it can go. */
import { describe, expect, it } from 'vitest'
import { EMERGENCY, newStop, reportOf, type StopPath } from './stopReport'
import type { StopStatus } from '../api/types'

const SENT = newStop(1, true, '12:03:05')
const FAILED: StopPath = { status: 'failed', problem: 'refused' }
const ANSWERED: StopPath = { status: 'answered', problem: '' }

function answer(changes: Partial<StopStatus> = {}, atRest = true): StopStatus {
  const devices = [{ name: 'world', connected: true, acknowledged: true, at_rest: atRest }]
  return { stop: 3, reason: '', acknowledged: true, at_rest: atRest, devices, engine: 'informed', after_s: 0.1, ...changes }
}

describe('a STOP of the cell', () => {
  it('is under way until one of its two paths answers', () => {
    expect(reportOf(SENT)).toEqual({ level: 'waiting', title: 'Stopping', lines: [] })
    expect(reportOf({ ...SENT, process: FAILED }).level).toBe('waiting')
    expect(reportOf({ ...SENT, engine: FAILED }).level).toBe('waiting')
  })

  it('is acknowledged by either path', () => {
    const moving = reportOf({ ...SENT, process: ANSWERED, answer: answer({}, false) })
    expect(moving).toEqual({ level: 'waiting', title: 'Stop acknowledged', lines: ['Coming to rest: world'] })
    expect(reportOf({ ...SENT, process: ANSWERED, answer: answer() })).toEqual({ level: 'done', title: 'All arms at rest', lines: [] })
    expect(reportOf({ ...newStop(1, false, ''), engine: ANSWERED })).toEqual({ level: 'done', title: 'All arms at rest', lines: [] })
  })

  it('names the engine that does not answer, and since when', () => {
    const silent = reportOf({ ...SENT, process: ANSWERED, answer: answer({ engine: 'silent' }) })
    expect(silent.level).toBe('warning')
    expect(silent.lines).toEqual(['Engine does not answer (silent since 12:03:05); arms are stopped by their controller.'])
    expect(reportOf({ ...SENT, process: ANSWERED, answer: answer({ engine: 'silent' }), engine: ANSWERED }).lines).toEqual([])
  })

  it('says which path failed although the other one worked', () => {
    expect(reportOf({ ...SENT, process: FAILED, engine: ANSWERED })).toEqual({
      level: 'warning',
      title: 'All arms at rest',
      lines: ['The stop process did not answer: refused'],
    })
  })

  it('asks for the emergency stop when nobody has acknowledged it, or something does not rest', () => {
    const cases = [
      { ...SENT, process: FAILED, engine: FAILED },
      { ...newStop(1, false, ''), engine: FAILED },
      { ...SENT, isUnanswered: true },
      { ...SENT, process: ANSWERED, answer: answer({}, false), isSlow: true },
      { ...SENT, process: ANSWERED, answer: answer({ devices: [{ name: 'left', connected: true, acknowledged: false, at_rest: true }] }) },
      { ...SENT, process: ANSWERED, answer: answer({ acknowledged: false }), engine: FAILED },
    ]
    for (const stop of cases) {
      expect(reportOf(stop).level).toBe('alarm')
      expect(reportOf(stop).lines[0]).toBe(EMERGENCY)
    }
  })
})
