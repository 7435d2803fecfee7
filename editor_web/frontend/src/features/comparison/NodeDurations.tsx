/** How often each node was visited in two runs, and how long all its visits took. */
import { Checkbox } from '@mantine/core'
import { useState } from 'react'
import type { NodeDifference } from '../../api/types'
import { signed } from '../../document/comparison'
import { duration } from '../../document/time'
import styles from './comparison.module.css'

export function NodeDurations({ nodes }: { readonly nodes: readonly NodeDifference[] }) {
  const [isByDifference, setByDifference] = useState(true)
  const change = (each: NodeDifference) => each.duration_right_s - each.duration_left_s
  const rows = isByDifference ? nodes.toSorted((one, other) => Math.abs(change(other)) - Math.abs(change(one))) : nodes
  return (
    <>
      <div className={styles.details}>
        <Checkbox
          size="xs"
          label="Largest difference first"
          checked={isByDifference}
          onChange={(event) => setByDifference(event.currentTarget.checked)}
        />
      </div>
      <table className={styles.table}>
        <thead>
          <tr>
            <th scope="col">Node</th>
            <th scope="col" className={styles.number}>
              Visits
            </th>
            <th scope="col" className={styles.number}>
              Left
            </th>
            <th scope="col" className={styles.number}>
              Right
            </th>
            <th scope="col" className={styles.number}>
              Difference
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map((each) => (
            <tr key={each.path}>
              <th scope="row">{each.path}</th>
              <td className={styles.number}>
                {each.visits_left === each.visits_right ? each.visits_left : `${each.visits_left} → ${each.visits_right}`}
              </td>
              <td className={styles.number}>{each.visits_left > 0 ? duration(each.duration_left_s) : ''}</td>
              <td className={styles.number}>{each.visits_right > 0 ? duration(each.duration_right_s) : ''}</td>
              <td className={styles.number}>{signed(change(each))}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  )
}
