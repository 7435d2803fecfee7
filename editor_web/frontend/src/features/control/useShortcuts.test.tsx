/** Single keys as commands, and the sheet that lists them and switches them off. */
import { screen } from '@testing-library/react'
import { useState } from 'react'
import { expect, it, vi } from 'vitest'
import { show } from '../../../testing/page'
import { SHORTCUTS } from '../../document/shortcuts'
import { ShortcutSheet } from './ShortcutSheet'
import { useShortcuts, type Actions } from './useShortcuts'

const done = vi.fn<(what: string) => void>()
const NAMES = ['pause', 'into', 'over', 'out', 'back', 'stop', 'break', 'lock', 'repeat', 'force', 'answer', 'waiting'] as const

function Keys() {
  const [isOpen, setOpen] = useState(false)
  const named = Object.fromEntries(NAMES.map((name) => [name, () => done(name)])) as unknown as Actions
  const keys = useShortcuts({ ...named, sheet: () => setOpen(true) })
  return (
    <>
      <input aria-label="Find" />
      <ShortcutSheet isOpen={isOpen} onClose={() => setOpen(false)} areOn={keys.areOn} onSwitch={keys.setOn} />
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

it('does nothing while somebody writes, or while a dialog is open', async () => {
  done.mockClear()
  const user = show(<Keys />)
  await user.type(screen.getByLabelText('Find'), 'pp')
  await user.click(document.body)
  await user.keyboard('?')
  expect(screen.getByRole('dialog', { name: 'Keyboard' })).toBeVisible()
  await user.keyboard('p')
  expect(done).not.toHaveBeenCalled()
})

it('lists every key, and is switched off and on again', async () => {
  done.mockClear()
  const user = show(<Keys />)
  await user.keyboard('?')
  expect(screen.getAllByRole('term').map((each) => each.textContent)).toEqual(SHORTCUTS.map(({ key }) => key))
  expect(screen.getByRole('dialog')).toHaveTextContent('Pause, or resume a paused run')
  await user.click(screen.getByLabelText('Single keys are commands'))
  await user.click(screen.getByRole('button', { name: 'Close' }))
  await user.keyboard('p?')
  expect(done).not.toHaveBeenCalled()
  expect(screen.queryByRole('dialog')).toBeNull()
})
