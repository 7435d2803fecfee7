/** What moves keeps its state. */
import { screen } from '@testing-library/react'
import { useState } from 'react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { Placed, useMovable } from './Movable'

function Counter() {
  const [count, setCount] = useState(0)
  return (
    <button type="button" onClick={() => setCount(count + 1)}>
      {count}
    </button>
  )
}

function Page() {
  const [place, setPlace] = useState('left')
  const counter = useMovable(<Counter />)
  return (
    <>
      {counter.source}
      {['left', 'right', 'away'].map((each) => (
        <button key={each} type="button" onClick={() => setPlace(each)}>
          {each}
        </button>
      ))}
      <div data-testid="left">{place === 'left' && <Placed host={counter.host} />}</div>
      <div data-testid="right">{place === 'right' && <Placed host={counter.host} />}</div>
      {place === 'away' && <Placed host={counter.host} isHidden />}
    </>
  )
}

it('keeps its state from place to place', async () => {
  const user = show(<Page />)
  await user.click(screen.getByRole('button', { name: '0' }))
  expect(screen.getByTestId('left')).toHaveTextContent('1')
  await user.click(screen.getByRole('button', { name: 'right' }))
  expect(screen.getByTestId('right')).toHaveTextContent('1')
  await user.click(screen.getByRole('button', { name: 'away' }))
  expect(screen.getByText('1')).not.toBeVisible()
  await user.click(screen.getByRole('button', { name: 'left' }))
  expect(screen.getByTestId('left')).toHaveTextContent('1')
})
