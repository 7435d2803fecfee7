/** Numbers of a value: what is typed counts at once, also with a zero at its end. */
import { screen } from '@testing-library/react'
import { useState } from 'react'
import { expect, it } from 'vitest'
import { show } from '../../testing/page'
import { VectorFields } from './VectorFields'

function Fields() {
  const [values, setValues] = useState([0.25, -1])
  return (
    <>
      <VectorFields label="Size" names={['x', 'y']} unit="m" digits={6} values={values} onChange={setValues} />
      <output>{JSON.stringify(values)}</output>
    </>
  )
}

it.each([
  ['1.0', 1, '1.0'],
  ['1.05', 1.05, '1.05'],
  ['-0.50', -0.5, '-0.50'],
  ['0.000001', 0.000001, '0.000001'],
])('takes %s while it is typed', async (text, value, shown) => {
  const user = show(<Fields />)
  const field = screen.getByLabelText('Size x')
  await user.clear(field)
  await user.type(field, text)
  expect(screen.getByRole('status')).toHaveTextContent(JSON.stringify([value, -1]))
  expect(field).toHaveValue(shown)
})

it('keeps the number while nothing or a sign alone is typed', async () => {
  const user = show(<Fields />)
  const field = screen.getByLabelText('Size y')
  await user.clear(field)
  await user.type(field, '-')
  expect(screen.getByRole('status')).toHaveTextContent('[0.25,-1]')
  await user.type(field, '2')
  expect(screen.getByRole('status')).toHaveTextContent('[0.25,-2]')
})
