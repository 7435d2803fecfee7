/** How long a behavior and its nodes took: median, quartiles, extremes, and the latest run beside them. */
import type { DurationSpread, NodeTrend } from '../../api/types'
import { duration } from '../../document/time'
import styles from './trend.module.css'

interface DurationTableProps {
  readonly whole: DurationSpread
  readonly nodes: readonly NodeTrend[]
}

export function DurationTable({ whole, nodes }: DurationTableProps) {
  return (
    <table className={styles.table}>
      <thead>
        <tr>
          <th scope="col">Node</th>
          {['Runs', 'Median', 'Quartiles', 'Least', 'Most', 'Latest'].map((name) => (
            <th key={name} scope="col" className={styles.number}>
              {name}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        <Row name="Whole run" spread={whole} />
        {nodes.map((node) => (
          <Row key={node.path} name={node.path} spread={node} />
        ))}
      </tbody>
    </table>
  )
}

function Row({ name, spread }: { readonly name: string; readonly spread: DurationSpread }) {
  const { count, median_s, lower_s, upper_s, least_s, most_s, last_s } = spread
  const isOutside = last_s !== null && (last_s < least_s || last_s > most_s)
  return (
    <tr>
      <th scope="row">{name}</th>
      <td className={styles.number}>{count}</td>
      <td className={styles.number}>{duration(median_s)}</td>
      <td className={styles.number}>
        {duration(lower_s)} to {duration(upper_s)}
      </td>
      <td className={styles.number}>{duration(least_s)}</td>
      <td className={styles.number}>{duration(most_s)}</td>
      <td
        className={`${styles.number} ${isOutside ? styles.outside : ''}`}
        title={isOutside ? 'Outside of what the runs that succeeded took' : undefined}
      >
        {last_s === null ? '–' : duration(last_s)}
      </td>
    </tr>
  )
}
