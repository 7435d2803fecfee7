/** The keys of the page of a run as commands. */
import { screen } from '@testing-library/react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import { setKeys, switchSingleKeys } from '../../api/keyMap'
import { useRunKeys, type RunActions } from './useRunKeys'

const done = vi.fn<(what: string) => void>()
const NAMES = [
  'pause',
  'into',
  'over',
  'out',
  'back',
  'stop',
  'break',
  'condition',
  'lock',
  'repeat',
  'force',
  'answer',
  'waiting',
] as const

function Keys() {
  useRunKeys(Object.fromEntries(NAMES.map((name) => [name, () => done(name)])) as unknown as RunActions)
  return (
    <>
      <input aria-label="Find" />
      <input type="checkbox" aria-label="Box" />
    </>
  )
}

it.each([
  ['p', 'pause'],
  ['i', 'into'],
  ['o', 'over'],
  ['u', 'out'],
  ['z', 'back'],
  ['b', 'break'],
  ['{Shift>}B{/Shift}', 'condition'],
  ['l', 'lock'],
  ['r', 'repeat'],
  ['f', 'force'],
  ['a', 'answer'],
  ['g', 'waiting'],
  ['{Shift>}S{/Shift}', 'stop'],
])('takes %s for %s', async (key, command) => {
  done.mockClear()
  const user = show(<Keys />)
  await user.keyboard(key)
  expect(done.mock.calls).toEqual([[command]])
})

it('leaves the keys of the browser alone, and those that somebody writes with', async () => {
  done.mockClear()
  const user = show(<Keys />)
  await user.keyboard('{Control>}p{/Control}s')
  await user.type(screen.getByLabelText('Find'), 'pp')
  expect(done).not.toHaveBeenCalled()
  await user.click(screen.getByLabelText('Box'))
  await user.keyboard('p')
  expect(done.mock.calls).toEqual([['pause']])
})

it('takes the keys that somebody has given, and no others', async () => {
  done.mockClear()
  setKeys('pause', [{ key: 'F9' }])
  const user = show(<Keys />)
  await user.keyboard('p')
  expect(done).not.toHaveBeenCalled()
  await user.keyboard('{F9}')
  expect(done.mock.calls).toEqual([['pause']])
})

it('takes no characters when they are switched off', async () => {
  done.mockClear()
  setKeys('into', [{ key: 'F7' }])
  switchSingleKeys(false)
  const user = show(<Keys />)
  await user.keyboard('p?')
  expect(done).not.toHaveBeenCalled()
  await user.keyboard('{F7}')
  expect(done.mock.calls).toEqual([['into']])
})
